/* SPDX-License-Identifier: GPL-3.0-or-later
 * The keys of the section `output` of a scene: path, kind, unit, range, default, choices and the text of the
 * documentation. Which names of fields and sets are allowed depends on the dimension and on the method;
 * check.c, average.c and tip_columns.c test that when the problem is known. */
#include "perigal/output.h"
#include "perigal/scene.h"

static const pg_key keys[] = {
    { "output.fields", PG_NAMES, NULL, "[0, 1000]", "[displacement, damage, stress]",
      "displacement|rotation|velocity|damage|stress|strain|error_estimate|nodal_force", NULL, NULL,
      "Fields that are written; rotation: of points, gmpd only; error_estimate: of the stress, by recovery; "
      "nodal_force: internal force of every point, at rest what loads and supports exert on it." },
    { .path = "output.format",
      .kind = PG_NAME,
      .fallback = PG_FIRST_CHOICE,
      .choices_of = pg_writer_names,
      .doc = "Format of the fields; `perigal list` says what each of these is. `perigal plot` and `perigal "
             "compare` read result.e only." },
    { "output.pictures", PG_NAMES, NULL, "[0, 100]", "[damage]", NULL, NULL, NULL,
      "Pictures of the last state: a field, or a part of one (displacement.y, stress.xx). Of a mesh: on its "
      "elements, while no bond is broken. []: none, and no charts either." },
    { "output.views", PG_LIST, NULL, "[0, 100]", "", NULL, NULL, NULL,
      "More pictures of the last state, each with its own view, range or name: {field: damage, view: "
      "back}." },
    { "output.views[].field", PG_TEXT, NULL, NULL, "", NULL, NULL, NULL,
      "A field, or a part of one, as in output.pictures; damage if not given." },
    { "output.views[].view", PG_NAME, NULL, NULL, "", "front|back|left|right|top|bottom|iso|crack", NULL,
      "look:most",
      "3D: the body from outside, seen from the side of that name (front is the face of largest z), or "
      "obliquely (iso, the default); crack: its damaged points alone." },
    { "output.views[].section", PG_TEXT, NULL, NULL, "", NULL, NULL, "look:most",
      "3D: a cut, AXIS = PLACE (z = 5 mm) or NORMAL = DISTANCE along it from the origin (1, 0, 1 = 5 mm)." },
    { "output.views[].direction", PG_VECTOR, "1", NULL, "", NULL, NULL, NULL,
      "View iso and crack: direction from the body to the observer; y points up." },
    { "output.views[].above", PG_NUMBER, "1", NULL, "", NULL, NULL, NULL,
      "3D views: only points whose field (SI) is at least this are drawn, the body grey behind them. View "
      "crack without it: damage 0.35." },
    { "output.views[].range", PG_NUMBERS, NULL, NULL, "", NULL, NULL, NULL,
      "Two ends of the colour bar (SI); from the values if not given, damage 0 to 1." },
    { "output.views[].magnify", PG_NUMBER, "1", "[0, inf)", "", NULL, NULL, NULL,
      "As output.magnify, for this picture." },
    { "output.views[].name", PG_TEXT, NULL, NULL, "", NULL, NULL, NULL,
      "Name of the file without .png; FIELD_VIEW if not given." },
    { "output.estimate", PG_BOOL, NULL, NULL, "on", NULL, NULL, NULL,
      "Static runs: estimated error of the last stress in report.json (stress recovery; takes less time than "
      "one assembly)." },
    { "output.stages", PG_BOOL, NULL, NULL, "off", NULL, NULL, NULL,
      "All pictures also each time fields are written, as stages/NAME_0007.png for the step 7 of these." },
    { "output.magnify", PG_NUMBER, "1", "[0, inf)", "0", NULL, NULL, NULL,
      "Pictures show the body deformed by this multiple of the displacement." },
    { "output.at.events", PG_INTEGER, NULL, "[1, 1000000000]", "", NULL, NULL, NULL,
      "Fields are also written at every n-th event (static: event stepping)." },
    { "output.at.broken", PG_NUMBER, "1", "(0, 1]", "", NULL, NULL, NULL,
      "Fields are also written each time another such share of all bonds has broken, also in the middle of a "
      "step." },
    { "output.checkpoint", PG_NUMBER, "s", "[0, inf)", "5 min", NULL, NULL, NULL,
      "Wall time between checkpoints, from which run --resume continues; 0: only when the run is "
      "interrupted or fails." },
    { "output.join", PG_NAME, NULL, NULL, "auto", "auto|yes|no", NULL, NULL,
      "Ranks that divide the body: whether rank 0 makes result.e of the parts when the run has ended, for "
      "which it has to hold the values of all points. auto: up to 2e7 points. One process ignores it, and "
      "parts of another format stay." },
    { "output.stress_intensity", PG_BOOL, NULL, NULL, "off", NULL, NULL, NULL,
      "Energy release rate J and stress intensity factors of every tip of a crack, as columns tip.N.J ... of "
      "history.csv and in tips.csv; in 3D of every vertex of its front, as columns front.N.J_max and in "
      "fronts.csv. Runs whose cracks grow by facets have them anyway." },
    { "output.crack_size", PG_BOOL, NULL, NULL, "off", NULL, NULL, NULL,
      "The new crack so far as a column of history.csv, crack.length in 2D, crack.area in 3D, where bonds or "
      "points break one by one: an estimate, by the count of broken bonds, or by the volume of failed points "
      "over the horizon. Runs whose cracks grow by facets have the column anyway." },
    { "output.averages", PG_LIST, NULL, "[0, 1000]", "", NULL, NULL, NULL,
      "Means of a field over a set, a column of history.csv each." },
    { "output.averages[].name", PG_TEXT, NULL, NULL, NULL, NULL, NULL, NULL, "Column name in history.csv." },
    { "output.averages[].set", PG_NAME, NULL, NULL, NULL, "sets.{}|left|right|bottom|top|back|front|all",
      NULL, NULL,
      "Over the points of which set: a set, a part of one (platens.top), or left, right, bottom, top, back, "
      "front, all." },
    { "output.averages[].field", PG_TEXT, NULL, NULL, NULL, NULL, NULL, NULL,
      "One component of a field: damage, displacement.y, stress.yy, strain.xy, rotation.z (gmpd; 2D: "
      "rotation) ..." },
    { "output.tips", PG_LIST, NULL, "[0, 100]", "", NULL, NULL, NULL,
      "Tips of cracks: how far from a place a crack has come along a direction, a column of history.csv "
      "each; tip.png, tip_speed.png and report.json show length and speed, beside the speed of Rayleigh "
      "waves." },
    { "output.tips[].name", PG_TEXT, NULL, NULL, NULL, NULL, NULL, NULL, "Column name in history.csv." },
    { "output.tips[].from", PG_VECTOR, "m", NULL, NULL, NULL, NULL, NULL,
      "Where the length is counted from; points behind it do not count." },
    { "output.tips[].along", PG_VECTOR, "1", NULL, NULL, NULL, NULL, NULL,
      "Direction in which the crack runs; its length does not matter." },
    { "output.tips[].damage", PG_NUMBER, "1", "(0, 1]", "35 %", NULL, NULL, NULL,
      "The tip is the farthest point of the crack with at least this damage, the crack being all such "
      "points that are connected to those nearest to from; beside a straight crack damage is about 0.4 "
      "(horizon of 3 spacings)." },
    { "output.tips[].where", PG_EXPRESSION, "bool", NULL, "", NULL, NULL, NULL,
      "Only points where this condition in x, y, z, r, angle holds: y > 0 for the upper of two branches." },
};
const pg_key_table pg_keys_results = { "results", keys, sizeof keys / sizeof *keys };
