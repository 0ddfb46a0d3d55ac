"""How full a bus is, and how long a frame waits at worst: from the model alone."""
