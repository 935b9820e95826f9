//! Replacement of `math.h` in C, for processors without a mathematical library.
//!
//! Angles are reduced by π/2 in three parts. Polynomials are on [−π/4, π/4] and [0, 7/16]. Their
//! coefficients, and π/2, are those of fdlibm's `k_sin.c`, `k_cos.c` and `s_atan.c` (Sun
//! Microsystems, 1993); in single precision those of Cephes' `sinf.c` (S. L. Moshier).

use std::collections::BTreeSet;

/// A name of a function, its text, and the function that it calls. Names in the text that begin
/// with `P_` get the prefix of the robot, those with `U_` the same in upper case.
type Row = (&'static str, &'static str, Option<&'static str>);

/// Each function is behind the one that it calls.
pub(super) const ROWS: [Row; 10] = [
    ("sin_cos", SINES, None),
    ("sin", SINE, Some("sin_cos")),
    ("cos", COSINE, Some("sin_cos")),
    ("sin_cosf", SINES_F, None),
    ("sinf", SINE_F, Some("sin_cosf")),
    ("cosf", COSINE_F, Some("sin_cosf")),
    ("sqrt", ROOT, None),
    ("sqrtf", ROOT_F, None),
    ("atan2", ARC, None),
    ("atan2f", ARC_F, Some("atan2")),
];

/// The requested functions, and those that they call.
pub(super) fn text(prefix: &str, called: &BTreeSet<String>) -> String {
    let is_called = |name: &str| called.contains(name) || ROWS.iter().any(|(own, _, calls)| *calls == Some(name) && called.contains(*own));
    let rows = ROWS.iter().filter(|(name, ..)| is_called(name));
    let all: String = rows.map(|(_, text, _)| *text).collect();
    all.replace("P_", &format!("{prefix}_")).replace("U_INLINE", &format!("{}_INLINE", prefix.to_ascii_uppercase()))
}

const SINES: &str = r"/* sin x, and cos x by the pointer: x in rad, |x| at most 1.6e6; not a number beyond. At most 1 ulp off. */
U_INLINE double P_sin_cos(double x, double *cosine) {
    if (!(x >= -1.6e6 && x <= 1.6e6)) {
        *cosine = (x - x) / (x - x);
        return *cosine;
    }
    /* The nearest multiple of pi/2, and what is left of x, in two parts. */
    const double n = (x * 0.63661977236758134308 + 6755399441055744.0) - 6755399441055744.0;
    const double a = x - n * 1.57079632673412561417e+00;
    const double b = n * 6.07710050630396597660e-11;
    const double t = a - b;
    const double c = n * 2.02226624879595063154e-21 - ((a - t) - b);
    const double y = t - c;
    const double low = (t - y) - c;
    const double z = y * y;
    const double v = z * y;
    const double p = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * (2.75573137070700676789e-06
        + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    const double s = y - ((z * (0.5 * low - v * p) - low) + v * 1.66666666666666324348e-01);
    const double h = 0.5 * z;
    const double w = 1.0 - h;
    const double r = z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05
        + z * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    const double k = w + (((1.0 - w) - h) + (z * r - y * low));
    switch ((int)n & 3) {
    case 0: *cosine = k; return s;
    case 1: *cosine = -s; return k;
    case 2: *cosine = -k; return -s;
    default: *cosine = s; return -k;
    }
}

";

const SINE: &str = r"U_INLINE double P_sin(double x) {
    double cosine;
    return P_sin_cos(x, &cosine);
}

";

const COSINE: &str = r"U_INLINE double P_cos(double x) {
    double cosine;
    (void)P_sin_cos(x, &cosine);
    return cosine;
}

";

const SINES_F: &str = r"/* sin x, and cos x by the pointer: x in rad, |x| at most 8192; not a number beyond. At most 2 ulp off, or 1e-7. */
U_INLINE float P_sin_cosf(float x, float *cosine) {
    if (!(x >= -8192.0f && x <= 8192.0f)) {
        *cosine = (x - x) / (x - x);
        return *cosine;
    }
    const int n = (int)(x * 0.636619772f + (x >= 0.0f ? 0.5f : -0.5f));
    const float m = (float)n;
    const float y = ((x - m * 1.5703125f) - m * 4.837512969970703125e-4f) - m * 7.54978995489188216e-8f;
    const float z = y * y;
    const float s = y + y * z * (-1.6666654611e-1f + z * (8.3321608736e-3f + z * -1.9515295891e-4f));
    const float k = 1.0f - 0.5f * z + z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f));
    switch (n & 3) {
    case 0: *cosine = k; return s;
    case 1: *cosine = -s; return k;
    case 2: *cosine = -k; return -s;
    default: *cosine = s; return -k;
    }
}

";

const SINE_F: &str = r"U_INLINE float P_sinf(float x) {
    float cosine;
    return P_sin_cosf(x, &cosine);
}

";

const COSINE_F: &str = r"U_INLINE float P_cosf(float x) {
    float cosine;
    (void)P_sin_cosf(x, &cosine);
    return cosine;
}

";

const ROOT: &str = r"/* The square root: Newton's steps for 1/sqrt x from half its exponent, then one for sqrt x. At most 1 ulp off. */
U_INLINE double P_sqrt(double x) {
    union { double number; unsigned long long bits; } y;
    if (!(x > 0.0) || x > 1e300) {
        /* Zero stays; a large number is taken a quarter at a time; others have no root. */
        return x == 0.0 ? x : x > 0.0 && x - x == 0.0 ? 1.157920892373162e77 * P_sqrt(x * 7.458340731200207e-155) : x > 0.0 ? x : (x - x) / (x - x);
    }
    if (x < 1e-290) {
        return 8.636168555094445e-78 * P_sqrt(x * 1.3407807929942597e154);
    }
    y.number = x;
    y.bits = 0x5fe6eb50c7b537a9ULL - (y.bits >> 1);
    for (int k = 0; k < 4; k++) {
        y.number = y.number * (1.5 - 0.5 * x * y.number * y.number);
    }
    const double r = x * y.number;
    return r + 0.5 * y.number * (x - r * r);
}

";

const ROOT_F: &str = r"/* The square root: Newton's steps for 1/sqrt x from half its exponent, then one for sqrt x. At most 1 ulp off. */
U_INLINE float P_sqrtf(float x) {
    union { float number; unsigned int bits; } y;
    if (!(x > 0.0f) || x > 1e36f) {
        return x == 0.0f ? x : x > 0.0f && x - x == 0.0f ? 4294967296.0f * P_sqrtf(x * 5.421010862427522e-20f) : x > 0.0f ? x : (x - x) / (x - x);
    }
    if (x < 1e-30f) {
        return 2.3283064365386963e-10f * P_sqrtf(x * 1.8446744073709552e19f);
    }
    y.number = x;
    y.bits = 0x5f375a86u - (y.bits >> 1);
    for (int k = 0; k < 3; k++) {
        y.number = y.number * (1.5f - 0.5f * x * y.number * y.number);
    }
    const float r = x * y.number;
    return r + 0.5f * y.number * (x - r * r);
}

";

const ARC: &str = r"/* The angle of the point (x, y), rad, in (-pi, pi]; 0 at the origin. At most 2 ulp off. */
U_INLINE double P_atan2(double y, double x) {
    static const double high[4] = {4.63647609000806093515e-01, 7.85398163397448278999e-01, 9.82793723247329054082e-01, 1.57079632679489655800e+00};
    static const double low[4] = {2.26987774529616870924e-17, 3.06161699786838301793e-17, 1.39033110312309984516e-17, 6.12323399573676603587e-17};
    const double u = x < 0.0 ? -x : x;
    const double v = y < 0.0 ? -y : y;
    double t, angle;
    int k;
    if (u == 0.0 && v == 0.0) {
        angle = 0.0;
    } else {
        /* atan(v/u) as atan(a) + atan(t), for the a of the table that is nearest */
        if (v < 0.4375 * u) { k = -1; t = v / u; }
        else if (v < 0.6875 * u) { k = 0; t = (2.0 * v - u) / (2.0 * u + v); }
        else if (v < 1.1875 * u) { k = 1; t = (v - u) / (u + v); }
        else if (v < 2.4375 * u) { k = 2; t = (v - 1.5 * u) / (u + 1.5 * v); }
        else { k = 3; t = -u / v; }
        const double z = t * t;
        const double w = z * z;
        const double a = z * (3.33333333333329318027e-01 + w * (1.42857142725034663711e-01 + w * (9.09088713343650656196e-02
            + w * (6.66107313738753120669e-02 + w * (4.97687799461593236017e-02 + w * 1.62858201153657823623e-02)))));
        const double b = w * (-1.99999999998764832476e-01 + w * (-1.11111104054623557880e-01 + w * (-7.69187620504482999495e-02
            + w * (-5.83357013379057348645e-02 + w * -3.65315727442169155270e-02))));
        angle = k < 0 ? t - t * (a + b) : high[k] - ((t * (a + b) - low[k]) - t);
    }
    if (x < 0.0) {
        angle = 3.14159265358979311600e+00 - (angle - 1.22464679914735317720e-16);
    }
    return y < 0.0 ? -angle : angle;
}

";

const ARC_F: &str = r"U_INLINE float P_atan2f(float y, float x) {
    return (float)P_atan2(y, x);
}

";
