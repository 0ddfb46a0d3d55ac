"""Rules about how a pack reacts to what a scenario does; outside of one they mean nothing."""
