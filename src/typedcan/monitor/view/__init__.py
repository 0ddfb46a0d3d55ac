"""The view in a terminal, by Textual: messages, signals and the pack."""

from typedcan.monitor.view.app import MonitorApp
from typedcan.monitor.view.run import run_view

__all__ = ["MonitorApp", "run_view"]
