"""What rules and reports measure of the frames: steps, silences, load, what lasts."""
