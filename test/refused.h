/* SPDX-License-Identifier: GPL-3.0-or-later
 * refused.h: scenes that must be refused with a message. */
#ifndef PERIGAL_TEST_REFUSED_H
#define PERIGAL_TEST_REFUSED_H
#include "check.h"
#include "perigal/solve.h"

/* Somewhere on the way to a solver the scene is refused, with this in the message, and nothing is left
 * over. */
static inline void refused_at (const char *text, const char *part, const char *file, int line)
{
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_solver_options options;
    pg_status status = pg_scene_parse (&scene, text, "test.yaml");
    size_t used = pg_memory_used ();
    if (status == PG_OK) status = pg_problem_build (&problem, scene, 1);
    if (status == PG_OK) status = pg_solver_options_read (&options, problem, scene);
    int begun = status == PG_OK;
    if (begun) status = pg_solver_create (&solver, problem, &options);
    if ((status != PG_E_SCENE && !(begun && status == PG_E_USAGE)) || !strstr (pg_last_error (), part)) {
        print_error ("status '%s', message '%s' where '%s' was expected\n", pg_status_text (status),
                     status ? pg_last_error () : "", part);
        _fail (file, line);
    }
    if (solver) _fail (file, line);
    pg_problem_free (&problem);
    if (scene && pg_memory_used () > used + 4096) _fail (file, line);      /* the scene keeps its faults */
    pg_scene_free (&scene);
}
#define check_refused(text, part) refused_at ((text), (part), __FILE__, __LINE__)
#endif
