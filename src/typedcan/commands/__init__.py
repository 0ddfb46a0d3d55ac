"""The commands for any protocol, one file each, imported when it is chosen."""
