"""Live nodes of any protocol: they send, receive, supervise and ask; what they tell are events."""
