"""Simulated nodes of the standard: what each says and does, on its own or all together."""
