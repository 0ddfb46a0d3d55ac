"""The kinds of transfers: what their parameters mean, and when a value is complete.

A kind is one file and a line in `typedcan.model.transfers.registry`. It says which parameters of a
spec it takes and what does not fit (what lint tells), it puts values together frame by frame, and
it splits them. Live runtime and decoder of logs hand the same frames to the same rules: nothing
here knows a bus, a clock or a column.

What a result of a text, or of numbered blocks, is worth
--------------------------------------------------------
A set is one frame of each number within the timeout, in any order; no frame counts in two sets.
Other content than a frame of that number had before is a conflict: all is dropped, and from then
on a result takes two complete sets in a row that are identical, without a conflict in between,
until there has been one. After three timeouts without any frame all is forgotten. From this
follows, when n is the number of frames in which the values differ:

- One value, whatever is lost, repeated or reordered: that value or nothing.
- Two nodes that send different values in turns, each its frames in order and without a pause of
  three timeouts, nothing lost since they began: only values that one of them sends. For three or
  more nodes this takes as many ``rounds`` as there are nodes.
- Two such nodes and losses, with ``rounds`` of 2 or after a first result: a value that nobody sent
  takes at least n lost frames, and certain ones. No receiver can do better: what is then left is
  what one node with that value would have sent.
- A value that changes, frames lost or repeated but in order: with ``rounds`` of 2 the old or the
  new value, unless it changes back before two sets are complete. With one round the same, once a
  first result was there; before that, a set that has frames of both values can pass.

Therefore what is sent again and again takes two rounds, and what is sent once on request takes
one: that is what a spec has that gives no number.

What a result of readings by group is worth
-------------------------------------------
Each frame is a measurement of its own. A result has for every reading what was received last, none
older than the window, and all of it received since the result before; whatever is lost, repeated
or reordered. It takes the totals that the sender tells, which are believed, or those of the spec.

How many readings a group has is often not sent. It is known once the last ones of all groups have
had a value, since only then do they make the total. Before that, all groups are taken to be alike
where the total can be divided so, no reading speaks against it, and all their frames came five
times: only groups that are not alike, with readings without a value at the end of one or frames
lost that often, can deceive this. Where the total cannot be divided, nothing is reported before it
is known. What is known is forgotten with other totals, and after twenty windows without a frame.
"""
