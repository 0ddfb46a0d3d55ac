"""A live bus as a person or a program wants to see it; a monitor is no node and sends nothing.

`watch` takes frames and says what they amount to, as a `picture`; it needs neither bus, thread
nor terminal. `session` adds the recording, `listener` the bus. `view` shows it all in a terminal,
and is the only part that needs Textual.
"""
