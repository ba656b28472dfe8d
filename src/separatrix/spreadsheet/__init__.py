"""Cells of an .xlsx workbook as they were saved: numbers, texts, and whether a formula stands behind them.

The parts of the workbook (ECMA-376, SpreadsheetML) are read by an XML parser without entities, straight from
the archive that `separatrix.archive` has judged. Nothing is evaluated: a formula has the value that was saved
with it. Macros and links to other files are never followed.
"""

from separatrix.spreadsheet.cells import Cell, Row, cell_name, column_name
from separatrix.spreadsheet.workbook import Workbook, open_workbook

__all__ = ["Cell", "Row", "Workbook", "cell_name", "column_name", "open_workbook"]
