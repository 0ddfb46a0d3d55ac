"""The checksum algorithms: one registry for specs, live codecs, columns and the judge."""
