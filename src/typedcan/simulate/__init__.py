"""Simulated buses, a world with its time, and faults of frames: for any protocol."""
