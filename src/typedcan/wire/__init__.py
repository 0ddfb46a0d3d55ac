"""Typed messages on a bus of python-can: the thin runtime."""
