/* SPDX-License-Identifier: GPL-3.0-or-later
 * A finite element result measured against the reference of a scene, by the norms that Perigal's own results are measured with. */
#include "cli.h"
#include "bench.h"

int bench_fem_main (int argc, char **argv)
{
    (void) argc, (void) argv;
    return EXIT_FAILED;
}
