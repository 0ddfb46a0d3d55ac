"""Signals, cells and probes of a log over time, as one HTML page or one picture.

Logs are read once, in blocks; of each signal so many values are kept as a screen can show: in each
of some thousand columns of equal length the first, the last, the lowest and the highest.
"""

from typedcan.logs.plot.collect import PlotRequest, read_plot
from typedcan.logs.plot.html import to_html
from typedcan.logs.plot.model import Plot
from typedcan.logs.plot.names import find_signals
from typedcan.logs.plot.picture import to_picture

__all__ = ["Plot", "PlotRequest", "find_signals", "read_plot", "to_html", "to_picture"]
