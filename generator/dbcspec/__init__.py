"""dbcspec: a CAN protocol as data - tables in YAML in, DBC files and typed Python stubs out."""
