"""What simulated nodes measure and switch: cells, relays, the charge path, the cooling."""
