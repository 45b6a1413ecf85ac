/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields at the points of a body from a mesh: on its elements, middle nodes between the corners where only
 * corners are points; as points where elements would not do. */
#include "check.h"
#include "fonts.h"
#include "io/output/sample.h"
#include "meshes.h"
#include "perigal/output.h"
#include "perigal/picture.h"

static const mesh_plan sheet = { to_box, { 4, 3, 1 }, 2, 0, PG_TRI6, NULL },
                       block = { to_box, { 3, 2, 2 }, 3, 0, PG_HEX20, NULL };
static const pg_picture_style plain = { .title = "t", .label = "v", .length = 1, .magnify = 2 };
typedef struct { pg_mesh_body body; pg_cloud cloud; double *value, *u, *node, *node_u; } made;

/* Linear in x: between corners it is at the middle nodes what the field says. */
static made make (const mesh_plan *plan, int corners)
{
    made m = { 0 };
    make_mesh (&m.body.mesh, plan);
    const pg_mesh *mesh = &m.body.mesh;
    size_t dim = (size_t) mesh->dim;
    m.cloud.dim = mesh->dim, m.cloud.h = 5, m.cloud.thickness = 1;
    m.body.point = pg_calloc (mesh->nnode, sizeof (int));
    m.cloud.x = pg_calloc (3 * mesh->nnode, sizeof (double)),
    m.cloud.volume = pg_calloc (mesh->nnode, sizeof (double)),
    m.cloud.block = pg_calloc (mesh->nnode, sizeof (int));
    m.value = pg_calloc (mesh->nnode, sizeof (double)), m.node = pg_calloc (mesh->nnode, sizeof (double));
    m.u = pg_calloc (3 * mesh->nnode, sizeof (double)),
    m.node_u = pg_calloc (3 * mesh->nnode, sizeof (double));
    for (size_t i = 0; i < mesh->nnode; i++) m.body.point[i] = corners ? -1 : 0;
    for (size_t e = 0; corners && e < mesh->n; e++)
        for (int k = 0; k < pg_element_types[mesh->kind[e]].corners; k++)
            m.body.point[mesh->node[mesh->start[e] + (size_t) k]] = 0;
    for (size_t i = 0; i < mesh->nnode; i++) {
        const double *x = mesh->x + 3 * i;
        m.node[i] = 2 * x[0] - x[1], m.node_u[i * dim] = 0.1 * x[1];
        if (m.body.point[i] < 0) continue;
        size_t p = m.cloud.n++;
        m.body.point[i] = (int) p, m.cloud.volume[p] = 25;
        memcpy (m.cloud.x + p * dim, x, dim * sizeof *x);
        m.value[p] = m.node[i], m.u[p * dim] = m.node_u[i * dim];
    }
    for (int k = 0; k < 3; k++) m.cloud.step[k] = 5, m.cloud.high[k] = k == 0 ? 80 : k == 1 ? 60 : 40;
    return m;
}

static void drop (made *m)
{
    pg_mesh_clear (&m->body.mesh);
    pg_free (m->body.point), pg_free (m->cloud.x), pg_free (m->cloud.volume), pg_free (m->cloud.block);
    pg_free (m->value), pg_free (m->u), pg_free (m->node), pg_free (m->node_u);
}

static size_t bytes_of (const char *path, unsigned char **out)
{
    FILE *f = fopen (path, "rb");
    assert_non_null (f);
    *out = pg_calloc (4 << 20, 1);
    size_t n = fread (*out, 1, 4 << 20, f);
    fclose (f);
    return n;
}

static int alike (const char *a, const char *b)
{
    unsigned char *p, *q;
    size_t n = bytes_of (a, &p), m = bytes_of (b, &q);
    int same = n == m && n > 1000 && memcmp (p, q, n) == 0;
    pg_free (p), pg_free (q);
    return same;
}

static void elements_show_what_is_at_their_nodes (void **state)
{
    (void) state;
    for (int k = 0; k < 4; k++) {
        made m = make (k < 2 ? &sheet : &block, k % 2);
        char a[400], b[400];
        snprintf (a, sizeof a, "%s", file_at ("points.png")),
            snprintf (b, sizeof b, "%s", file_at ("nodes.png"));
        pg_picture_style style = plain;
        style.u = m.u;
        check_ok (pg_picture_body (a, &m.body, &m.cloud, m.value, &style));
        style.u = m.node_u;
        check_ok (pg_picture_mesh (b, &m.body.mesh, m.node, &style));
        assert_true (alike (a, b));
        drop (&m);
    }
}

static void points_where_elements_will_not_do (void **state)
{
    (void) state;
    made m = make (&block, 0);
    pg_crack crack = { .kind = PG_CRACK_DISC, .normal = { 1, 0, 0 }, .radius = 1 };
    pg_cracks cracks = { .dim = 3, .crack = &crack, .n = 1 };
    pg_picture_style style = plain;
    assert_true (pg_picture_on_elements (&m.body, &style));
    assert_false (pg_picture_on_elements (NULL, &style));
    style.cracks = &cracks;
    assert_false (pg_picture_on_elements (&m.body, &style));
    style = plain, style.section = 3;
    assert_false (pg_picture_on_elements (&m.body, &style));
    style = plain, style.view = PG_VIEW_CRACK;
    assert_false (pg_picture_on_elements (&m.body, &style));
    style = plain, style.select = m.value;
    assert_false (pg_picture_on_elements (&m.body, &style));
    char a[400], b[400];
    snprintf (a, sizeof a, "%s", file_at ("a.png")), snprintf (b, sizeof b, "%s", file_at ("b.png"));
    style = plain, style.view = PG_VIEW_ISO, style.magnify = 0;
    check_ok (pg_picture_body (a, NULL, &m.cloud, m.value, &style));
    check_ok (pg_picture_field (b, &m.cloud, m.value, &style));
    assert_true (alike (a, b));
    check_ok (pg_picture_body (b, &m.body, &m.cloud, m.value, &style));
    assert_false (alike (a, b));
    drop (&m);
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    made m = make (&sheet, 1);
    pg_picture_style style = plain;
    style.u = m.u;
    const char *path = file_at ("memory.png");
    size_t before = pg_memory_used (), k = 1;
    pg_status status = PG_E_MEMORY;
    for (; status == PG_E_MEMORY; k++) {
        pg_memory_fail_at (k);
        status = pg_picture_body (path, &m.body, &m.cloud, m.value, &style);
        pg_memory_fail_at (0);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < 200);
    }
    check_ok (status);
    assert_true (k > 3);
    drop (&m);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (elements_show_what_is_at_their_nodes),
        cmocka_unit_test (points_where_elements_will_not_do),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/picture_body", tests, NULL, remove_folder);
}
