"""The commands of `dbcspec`, one file each: `add` declares it, the rest does it."""
