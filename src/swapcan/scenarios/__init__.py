"""Conformance on a live bus: listening to it, and driving a pack through scenarios."""
