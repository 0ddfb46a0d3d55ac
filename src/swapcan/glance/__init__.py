"""What the monitor shows of this standard beside messages and signals."""
