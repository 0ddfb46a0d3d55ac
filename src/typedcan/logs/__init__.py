"""Hours of bus traffic into columns, for any protocol: log files in, tables out."""
