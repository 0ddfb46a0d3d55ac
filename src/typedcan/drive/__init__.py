"""Driving a bus from the command line: looking out for others, living on it, leaving it safe."""
