"""The commands of `swapcan`, a module each, and what they share."""
