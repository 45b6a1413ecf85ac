/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over a list of bonds, one bond after the other. */
#include "list.h"
#include <math.h>
#include <string.h>

#define SET    _scalar
#define TARGET
#define V      double
#define WIDTH  1
#define V_LOAD(p)        (*(p))
#define V_SET(s)         (s)
#define V_ROOT(v)        sqrt (v)
#define V_KEEP(v, bits)  ((bits) ? (v) : 0.0)
#define V_LEAST(a, b)    ((a) >= (b) ? 1u : 0u)
#define V_FETCH1(record, o) const double *r_ = (record) + *(o), x0 = r_[0], u0 = r_[1]
#define V_FETCH2(record, o) const double *r_ = (record) + *(o), x0 = r_[0], x1 = r_[1], u0 = r_[2], u1 = r_[3]
#define V_FETCH3(record, o) \
    const double *r_ = (record) + *(o), x0 = r_[0], x1 = r_[1], x2 = r_[2], u0 = r_[3], u1 = r_[4], u2 = r_[5]
#define V_GIVE1(sum, o) ((sum)[*(o) / 2] -= f0)
#define V_GIVE2(sum, o) ((sum)[*(o) / 2] -= f0, (sum)[*(o) / 2 + 1] -= f1)
#define V_GIVE3(sum, o) ((sum)[*(o) / 2] -= f0, (sum)[*(o) / 2 + 1] -= f1, (sum)[*(o) / 2 + 2] -= f2)

#define DIM 1
#include "list_kernel.h"
#define DIM 2
#include "list_kernel.h"
#define DIM 3
#include "list_kernel.h"

const bond_list_kernel bond_list_scalar[3][2][2] = {
    { { linear1_scalar, linear_check1_scalar }, { finite1_scalar, finite_check1_scalar } },
    { { linear2_scalar, linear_check2_scalar }, { finite2_scalar, finite_check2_scalar } },
    { { linear3_scalar, linear_check3_scalar }, { finite3_scalar, finite_check3_scalar } } };
