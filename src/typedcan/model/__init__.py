"""What a protocol is: frozen, and without dependencies."""
