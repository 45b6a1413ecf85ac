/* SPDX-License-Identifier: GPL-3.0-or-later
 * For programs that draw text: fontconfig keeps a few hundred bytes for good, which the leak checker need not
 * report. Weak: several tests of one program say so. */
#ifndef PERIGAL_TEST_OUTPUT_FONTS_H
#define PERIGAL_TEST_OUTPUT_FONTS_H
__attribute__ ((weak)) const char *__lsan_default_suppressions (void);
const char *__lsan_default_suppressions (void) { return "leak:libfontconfig\n"; }
#endif
