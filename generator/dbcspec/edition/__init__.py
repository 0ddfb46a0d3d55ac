"""A first patch of a supplier's file: what it says otherwise than a spec, as an edition of it."""
