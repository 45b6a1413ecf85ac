/* SPDX-License-Identifier: GPL-3.0-or-later
 * cases.h: the table of benchmark cases: a scene, its changes, and what the result is measured against. */
#ifndef PERIGAL_BENCH_CASES_H
#define PERIGAL_BENCH_CASES_H

enum { OVERRIDES = 8 };
enum { NO_REFERENCE, DISK_CENTRE };  /* DISK_CENTRE: 2P/(pi D t) across, -6P/(pi D t) along the load */
typedef struct {
    const char *group, *name, *scene;
    int         reference;
    const char *set[OVERRIDES];                        /* "key=value", NULL after the last */
} bench_case;

#define CRACKED "data/cui_disk_plane/scene.yaml"
#define WHOLE   "data/disk_uncracked/scene.yaml"
static const bench_case cases[] = {
    /* uncracked disk: error against size */
    { "uncracked", "uncracked-4", WHOLE, DISK_CENTRE, { "spacing=4 mm" } },
    { "uncracked", "uncracked-2", WHOLE, DISK_CENTRE, { "spacing=2 mm" } },
    { "uncracked", "uncracked-1", WHOLE, DISK_CENTRE, { "spacing=1 mm" } },
    { "uncracked", "uncracked-0.5", WHOLE, DISK_CENTRE, { "spacing=0.5 mm" } },
    /* cracked disk: cost of an event against size; the first 400 events */
    { "events", "events-4", CRACKED, NO_REFERENCE, { "spacing=4 mm", "solver.max_events=400" } },
    { "events", "events-2", CRACKED, NO_REFERENCE, { "spacing=2 mm", "solver.max_events=400" } },
    { "events", "events-1.25", CRACKED, NO_REFERENCE, { "spacing=1.25 mm", "solver.max_events=400" } },
    /* cracked disk at 2 mm, to the end: which bonds break before the next solve */
    { "break", "break-event", CRACKED, NO_REFERENCE, { "solver.stepping=event", "solver.break=worst" } },
    { "break",
      "break-worst",
      CRACKED,
      NO_REFERENCE,
      { "solver.stepping=fixed", "solver.steps=40", "solver.break=worst" } },
    { "break",
      "break-fraction",
      CRACKED,
      NO_REFERENCE,
      { "solver.stepping=fixed", "solver.steps=40", "solver.break=fraction" } },
    { "break",
      "break-all",
      CRACKED,
      NO_REFERENCE,
      { "solver.stepping=fixed", "solver.steps=40", "solver.break=all" } },
};
enum { CASES = sizeof cases / sizeof *cases };
#endif
