/* SPDX-License-Identifier: GPL-3.0-or-later
 * Faces of cracks beside other cracks and platens: what pieces remember is their own; faces that nothing
 * keeps apart overlap, and that is told. */
#include "scene_runs/run.h"
#include "solve/contact/contact.h"

/* A block between a held and a moving platen. */
#define BETWEEN_PLATENS(cracks) \
    "dimension: 2\nplane: stress\nthickness: 0.5\nbody: [{add: {box: {low: [0, 0], high: [1, 2]}}}]\n" \
    "spacing: 0.1\nlattice: cells\nmaterials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n" \
    "cracks: [" cracks "]\nplatens:\n  - {name: base, point: [0.5, 0], normal: [0, 1], friction: 0.1}\n" \
    "  - {name: head, point: [0.5, 2], normal: [0, -1], displacement: {y: -0.02}}\n" \
    "solver: {kind: static, stepping: fixed, steps: 2}\n"

static void platens_do_not_hide_faces_that_overlap (void **state)
{
    (void) state;
    static const char *const contact[2] = { "", "contact: {kind: normal}\n" };
    double overlap[2];
    for (int i = 0; i < 2; i++) {
        run r = scene_of (1, "%s%s", BETWEEN_PLATENS ("{from: [0.21, 1.03], to: [0.79, 1.03]}"), contact[i]);
        to_the_end (&r);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        int told = 0;
        for (size_t k = 0; k < s->nwarning; k++)
            told |= strstr (s->warning[k], "contact is not modelled") != NULL;
        overlap[i] = s->contact.overlap_max;
        assert_int_equal (told, i == 0);
        clear (&r);
    }
    print_message ("overlap %.3g without contact, %.3g with it\n", overlap[0], overlap[1]);
    assert_true (overlap[0] > 2e-3 && overlap[1] < 0.05 * overlap[0]);
}

/* Made again where they are, pieces remember what they did, also where another crack crosses theirs or a
 * platen begins beside them. */
static void pieces_remember_their_own (void **state)
{
    (void) state;
    run r = scene_of (1, "%scontact: {kind: friction, coefficient: 0.1}\n",
                      BETWEEN_PLATENS ("{from: [0.23, 0.52], to: [0.81, 1.47]}, "
                                       "{from: [0.77, 0.81], to: [0.19, 1.13]}, "
                                       "{from: [0.31, -0.1], to: [0.52, 0.33]}"));
    to_the_end (&r);
    pg_system *s = &r.solver->break_loop.system;
    struct system_contact *c = s->contact;
    contact_layout l = contact_layout_of (2);
    size_t n = c->now.n;
    double *before = pg_calloc (n, l.values * sizeof *before), most = 0;
    assert_non_null (before);
    memcpy (before, c->now.value, n * l.values * sizeof *before);
    check_ok (contact_refresh (s, r.state, NULL));
    assert_int_equal (c->now.n, n);
    for (size_t k = 0; k < n; k++) most = fmax (most, fabs (before[k * l.values + l.slip]));
    assert_true (most > 1e-4);
    for (size_t k = 0; k < n; k++)
        for (size_t i = l.slip; i < l.values; i++)
            check_scaled (c->now.value[k * l.values + i], before[k * l.values + i], 1e-12, most);
    pg_free (before);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (platens_do_not_hide_faces_that_overlap),
        cmocka_unit_test (pieces_remember_their_own),
    };
    return cmocka_run_group_tests_name ("contact/faces", tests, NULL, NULL);
}
