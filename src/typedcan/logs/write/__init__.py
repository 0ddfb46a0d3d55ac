"""Tables into files of every kind, or into memory; which one, a name's suffix says."""
