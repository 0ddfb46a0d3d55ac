"""Speaking a protocol in another reading or edition with the message classes of a program."""
