"""The runtime for any CAN protocol: one model of it, databases in, typed messages on a bus."""
