"""Logs of tribometers as friction over time, distance or cycles, in SI units."""

from __future__ import annotations

from separatrix.friction.logs.column_map import ColumnMap, column_map, read_column_map
from separatrix.friction.logs.log import Conditions, RawLog
from separatrix.friction.logs.reading import described, read_log

__all__ = ["ColumnMap", "Conditions", "RawLog", "column_map", "described", "read_column_map", "read_log"]
