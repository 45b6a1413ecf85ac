/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per writer of fields: src/io/output/<name>.c ends in `const pg_writer pg_writer_<name>`. */
PG_WRITER (exodus)
PG_WRITER (vtk)
