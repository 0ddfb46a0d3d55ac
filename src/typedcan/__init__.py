"""The runtime for any CAN protocol: it names no message, signal or node of one."""
