"""One column per cell or probe, one row per complete cycle, from transfers by groups of sensors.

The rules are those of the live runtime. A cycle has each frame of each CSC; how many CSCs and
cells there are, another message says: the totals. A row has for every cell what was received last
for it, none older than one and a half periods, and all of it received since the row before. What
stays incomplete that long is counted. Frames of different channels are never put together.

Totals that are sent on request only come late in many logs, or not at all. The live
runtime reports nothing until then. In logs, by default, a cycle has as long what was seen in the
first two seconds: the frames that came at least half as often as the most frequent one, and of
each CSC the cells up to the last that had a value. With ``assume_seen=False`` nothing is assumed.
"""

from typedcan.logs.transfers.assembly import CycleCounts
from typedcan.logs.transfers.cycles import CycleTable, ReadingColumns
from typedcan.logs.transfers.readings import ColumnsError, Readings

__all__ = ["ColumnsError", "CycleCounts", "CycleTable", "ReadingColumns", "Readings"]
