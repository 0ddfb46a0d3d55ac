"""What changed between two protocols, and whom it breaks: one promise, one file."""
