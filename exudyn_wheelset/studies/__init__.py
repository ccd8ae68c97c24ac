"""Studies: any function of a case over any set of cases, on any executor."""

from exudyn_wheelset.studies.cases import files, grid, latin_hypercube, table_rows
from exudyn_wheelset.studies.running import study
from exudyn_wheelset.studies.tables import Study, Table

__all__ = ["Study", "Table", "files", "grid", "latin_hypercube", "study", "table_rows"]
