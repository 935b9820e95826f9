//! Vectors in C: one number of each of several states, by the vector extensions of GCC and Clang.
//!
//! A vector is as wide as the registers that the file is compiled for. Other compilers, and those
//! that define `PREFIX_NO_VECTORS`, compute one state at a time with the same text.
//!
//! The sines are those of `runtime/core/src/lanes/text/sines`, where products and sums are rounded
//! one after the other: they hold with and without contracted multiply-adds.

use std::collections::BTreeSet;

use articulated_core::lanes::Real;

use super::requirements::Requirements;

/// How many states a block has: a cache line of each number.
pub(super) fn states_of_block(real: Real) -> usize {
    64 / real.bytes()
}

/// The width of vectors, once for all types.
pub(super) fn width(prefix: &str) -> String {
    WIDTH.replace("@U_", &format!("{}_", prefix.to_ascii_uppercase()))
}

/// Vectors of a type of numbers, with the functions that are called.
pub(super) fn text(prefix: &str, real: Real, own_math: bool, called: &BTreeSet<&str>) -> String {
    let tag = format!("{prefix}_{}_", real.name());
    let calls = |names: &[&str]| names.iter().any(|name| called.contains(name));
    let mut out = String::from(TYPES);
    for (names, text) in [(&["k", "sin_cos"][..], CONSTANT), (&["select"], SELECT), (&["any"], ANY), (&["sqrt"], SQRT), (&["atan2"], ATAN2)]
    {
        if calls(names) {
            out += text;
        }
    }
    if calls(&["sin_cos"]) {
        let (types, sines) = if real == Real::F64 { ("", SINES) } else { (WIDE_TYPES, SINES_F) };
        out += types;
        out += &[OF_STATES[0], sines, TURN, OF_STATES[1]].concat();
    }
    out += TILES;
    let lanes = format!("{}_{}_LANES", prefix.to_ascii_uppercase(), real.name().to_ascii_uppercase());
    filled(&out, prefix, (real, &tag, &lanes), own_math)
}

/// Vectors of limbs, and sines and cosines of four angles of one state, as far as they are called.
pub(super) fn of_limbs(prefix: &str, own_math: bool, called: &Requirements) -> String {
    let Requirements { sines_of_four: of_state, sines_of_limbs: of_limbs, .. } = *called;
    let mut out = String::new();
    for width in called.limbs.iter().rev() {
        let text = LIMB_TYPES.replace("@SIZE", &(8 * width).to_string());
        out += &filled(&text, prefix, (Real::F64, &format!("{prefix}_x{width}_"), "4"), own_math);
    }
    let sines = if of_state || of_limbs { [OF_LIMBS[0], SINES, TURN, OF_LIMBS[1]].concat() } else { String::new() };
    let text = sines + if of_state { OF_FOUR } else { "" };
    out + &filled(&text, prefix, (Real::F64, &format!("{prefix}_x4_"), "4"), own_math)
}

/// A text with its words: `@P_` is the prefix of the robot and `@U_` the same in upper case; `@T_`
/// begins the names of a type of numbers.
fn filled(text: &str, prefix: &str, (real, tag, lanes): (Real, &str, &str), own_math: bool) -> String {
    let (number, integer, suffix, letter, top, limit) = match real {
        Real::F64 => ("double", "long long", "", "d", "62", "1e5"),
        Real::F32 => ("float", "int", "f", "", "30", "1e4f"),
    };
    let math = if own_math { format!("{prefix}_") } else { String::new() };
    let words = [
        ("T_", tag),
        ("P_", &format!("{prefix}_")),
        ("U_", &format!("{}_", prefix.to_ascii_uppercase())),
        ("REAL", number),
        ("INTEGER", integer),
        ("BLOCK", &states_of_block(real).to_string()),
        ("TILE", &(4 * real.bytes()).to_string()),
        ("BYTES", &real.bytes().to_string()),
        ("LANES", lanes),
        ("LIMIT", limit),
        ("TOP", top),
        ("MATH_SIN", &format!("{math}sin{suffix}")),
        ("MATH_COS", &format!("{math}cos{suffix}")),
        ("MATH_SQRT", &format!("{math}sqrt{suffix}")),
        ("MATH_ATAN2", &format!("{math}atan2{suffix}")),
        ("SHORT", if real == Real::F64 { "pd" } else { "ps" }),
        ("LETTER", letter),
        ("NEON", real.name()),
    ];
    words.iter().fold(text.to_owned(), |text, (word, by)| text.replace(&format!("@{word}"), by))
}

/// All texts with names of helpers: [`filled`] fills their words.
pub(super) const TEXTS: [&str; 18] = [
    WIDTH,
    TYPES,
    CONSTANT,
    SELECT,
    ANY,
    SQRT,
    ATAN2,
    SINES,
    SINES_F,
    WIDE_TYPES,
    TURN,
    OF_STATES[0],
    OF_STATES[1],
    LIMB_TYPES,
    OF_LIMBS[0],
    OF_LIMBS[1],
    OF_FOUR,
    TILES,
];

const WIDTH: &str = "\
/* Bytes of a vector: of the widest registers that this is compiled for; 0 without vectors. Define @U_NO_VECTORS to have none. */
#if !defined(__GNUC__) || defined(@U_NO_VECTORS) || !(defined(__SSE2__) || defined(__aarch64__) || defined(__wasm_simd128__))
#define @U_VECTOR 0
#elif defined(__AVX512F__) && defined(__AVX512DQ__)
#define @U_VECTOR 64
#elif defined(__AVX__)
#define @U_VECTOR 32
#else
#define @U_VECTOR 16
#endif
/* Limbs in lanes need shuffles too. */
#if @U_VECTOR && (defined(__clang__) || __GNUC__ >= 12)
#define @U_LIMBS 1
#else
#define @U_LIMBS 0
#endif
#if defined(__GNUC__)
#define @U_ALIGNED __attribute__((aligned(64)))
#else
#define @U_ALIGNED
#endif
#if @U_VECTOR && (defined(__SSE2__) || defined(__AVX__))
#include <immintrin.h>
#elif @U_VECTOR && defined(__aarch64__)
#include <arm_neon.h>
#endif

";

/// A vector of each type, and how it is read and written.
const TYPES: &str = "\
#if @U_VECTOR
/* One number of each state. */
typedef @REAL @T_v __attribute__((vector_size(@U_VECTOR)));
/* Truths: all bits of a lane are equal. */
typedef @INTEGER @T_m __attribute__((vector_size(@U_VECTOR)));
typedef unsigned @INTEGER @T_b __attribute__((vector_size(@U_VECTOR)));
typedef @REAL @T_u __attribute__((vector_size(@U_VECTOR), aligned(@BYTES), may_alias));
#define @LANES (@U_VECTOR / @BYTES)
@U_INLINE @T_v @T_load(const @REAL *from) {
    return (@T_v)*(const @T_u *)(const void *)from;
}
@U_INLINE void @T_store(@REAL *to, @T_v x) {
    *(@T_u *)(void *)to = (@T_u)x;
}
#else
typedef @REAL @T_v;
typedef int @T_m;
#define @LANES 1
@U_INLINE @T_v @T_load(const @REAL *from) {
    return *from;
}
@U_INLINE void @T_store(@REAL *to, @T_v x) {
    *to = x;
}
#endif

";

const CONSTANT: &str = "\
/* x in every lane. */
@U_INLINE @T_v @T_k(@REAL x) {
#if @U_VECTOR
    const @T_v zero = {0};
    return x - zero;
#else
    return x;
#endif
}

";

const SELECT: &str = "\
/* a where m is true, else b. */
@U_INLINE @T_v @T_select(@T_m m, @T_v a, @T_v b) {
#if @U_VECTOR
    return (@T_v)((m & (@T_m)a) | (~m & (@T_m)b));
#else
    return m ? a : b;
#endif
}

";

const ANY: &str = "\
/* Whether m is true in a lane. */
@U_INLINE int @T_any(@T_m m) {
#if @U_VECTOR
    int any = 0;
    for (int i = 0; i < @LANES; i++) {
        any |= m[i] != 0;
    }
    return any;
#else
    return m;
#endif
}

";

const SQRT: &str = "\
@U_INLINE @T_v @T_sqrt(@T_v x) {
#if @U_VECTOR == 64
    return (@T_v)_mm512_sqrt_@SHORT((__m512@LETTER)x);
#elif @U_VECTOR == 32
    return (@T_v)_mm256_sqrt_@SHORT((__m256@LETTER)x);
#elif @U_VECTOR && defined(__SSE2__)
    return (@T_v)_mm_sqrt_@SHORT((__m128@LETTER)x);
#elif @U_VECTOR && defined(__aarch64__)
    return (@T_v)vsqrtq_@NEON(x);
#elif @U_VECTOR
    for (int i = 0; i < @LANES; i++) {
        x[i] = @MATH_SQRT(x[i]);
    }
    return x;
#else
    return @MATH_SQRT(x);
#endif
}

";

const ATAN2: &str = "\
@U_INLINE @T_v @T_atan2(@T_v y, @T_v x) {
#if @U_VECTOR
    for (int i = 0; i < @LANES; i++) {
        y[i] = @MATH_ATAN2(y[i], x[i]);
    }
    return y;
#else
    return @MATH_ATAN2(y, x);
#endif
}

";

/// The sines of a vector x: `s` and `t` are its sines and cosines.
const SINES: &str = "\
    /* x = n*pi/2 + hi + lo, |hi| at most pi/4 and a little; n is in the low bits of `rounded`. */
    const @T_v rounded = x * 0.63661977236758134308 + 6755399441055744.0;
    const @T_v n = rounded - 6755399441055744.0;
    const @T_v r = x - n * 1.5707963267341256;
    const @T_v hi = r - n * 6.077100506303966e-11;
    const @T_v lo = ((r - hi) - n * 6.077100506303966e-11) - n * 2.0222662487959506e-21;
    const @T_v z = hi * hi;
    const @T_v zz = z * z;
    const @T_v half = z * 0.5;
    const @T_v w = 1.0 - half;
    const @T_v p = zz * (zz * 1.58969099521155010221e-10 + (z * -2.50507602534068634195e-08 + 2.75573137070700676789e-06))
        + (z * -1.98412698298579493134e-04 + 8.33333333332248946124e-03);
    const @T_v sine = hi + ((hi * z) * (z * p + -1.66666666666666324348e-01) + lo * w);
    const @T_v c = zz * (zz * (z * -1.13596475577881948265e-11 + 2.08757232129817482790e-09)
        + (z * -2.75573143513906633035e-07 + 2.48015872894767294178e-05)) + (z * -1.38888888888741095749e-03 + 4.16666666666666019037e-02);
    const @T_v other = w + (zz * c + (((1.0 - w) - half) - hi * lo));
    const @T_b bits = (@T_b)rounded;
";

const SINES_F: &str = "\
    /* x = n*pi/2 + hi + lo, |hi| at most pi/4 and a little, by way of double; n is in the low bits of `rounded`. */
    const @T_d wide = __builtin_convertvector(x, @T_d);
    const @T_d rounded = wide * 0.63661977236758134308 + 6755399441055744.0;
    const @T_d n = rounded - 6755399441055744.0;
    const @T_d r = (wide - n * 1.5707963267341256) - n * 6.077100506506192e-11;
    const @T_v hi = __builtin_convertvector(r, @T_v);
    const @T_v lo = __builtin_convertvector(r - __builtin_convertvector(hi, @T_d), @T_v);
    const @T_v z = hi * hi;
    const @T_v half = z * 0.5f;
    const @T_v w = 1.0f - half;
    const @T_v p = z * (z * -1.9515295891e-4f + 8.3321608736e-3f) + -1.6666654611e-1f;
    const @T_v sine = hi + ((hi * z) * p + lo);
    const @T_v c = z * (z * 2.443315711809948e-5f + -1.388731625493765e-3f) + 4.166664568298827e-2f;
    const @T_v other = w + ((z * z) * c + (((1.0f - w) - half) - hi * lo));
    const @T_b bits = __builtin_convertvector((@T_db)rounded, @T_b);
";

/// Types for the sines of `float`.
const WIDE_TYPES: &str = "\
#if @U_VECTOR
typedef double @T_d __attribute__((vector_size(2 * @U_VECTOR)));
typedef unsigned long long @T_db __attribute__((vector_size(2 * @U_VECTOR)));
#endif
";

/// The rest: the quadrant, and angles beyond the limit.
const TURN: &str = "\
    /* The quadrant: exchange for an odd one, and signs. */
    const @T_b odd = -(bits & 1);
    @T_v s = (@T_v)(((odd & (@T_b)other) | (~odd & (@T_b)sine)) ^ ((bits & 2) << @TOP));
    @T_v t = (@T_v)(((odd & (@T_b)sine) | (~odd & (@T_b)other)) ^ (((bits + 1) & 2) << @TOP));
    const @T_m within = (x >= -@LIMIT) & (x <= @LIMIT);
    @INTEGER all = -1;
    for (int i = 0; i < @LANES; i++) {
        all &= within[i];
    }
    if (!all) {
        for (int i = 0; i < @LANES; i++) {
            if (!within[i]) {
                s[i] = @MATH_SIN(x[i]);
                t[i] = @MATH_COS(x[i]);
            }
        }
    }
";

/// The function of a vector of states, around the sines.
const OF_STATES: [&str; 2] = [
    "\
/* sin x, and cos x by the pointer: x in rad, any; at most 1 ulp off up to @LIMIT, beyond as the mathematical library. */
@U_INLINE @T_v @T_sin_cos(@T_v x, @T_v *cosine) {
#if @U_VECTOR
",
    "\
    *cosine = t;
    return s;
#else
    *cosine = @MATH_COS(x);
    return @MATH_SIN(x);
#endif
}

",
];

/// A vector of several doubles of one state.
const LIMB_TYPES: &str = "\
#if @U_VECTOR
typedef double @T_v __attribute__((vector_size(@SIZE)));
typedef long long @T_m __attribute__((vector_size(@SIZE)));
typedef unsigned long long @T_b __attribute__((vector_size(@SIZE)));
typedef double @T_u __attribute__((vector_size(@SIZE), aligned(8), may_alias));
#endif

";

/// The function of a vector of angles of one state, around the sines.
const OF_LIMBS: [&str; 2] = [
    "\
#if @U_VECTOR
/* Sines and cosines of four angles, rad: any; at most 1 ulp off up to @LIMIT, beyond as the mathematical library. */
@U_INLINE void @T_sin_cos(const @T_v *angles, @T_v *sines, @T_v *cosines) {
    const @T_v x = *angles;
",
    "\
    *sines = s;
    *cosines = t;
}
#endif

",
];

/// The same for n angles that are not a vector.
const OF_FOUR: &str = "\
/* Sines and cosines of n angles, at most four, rad. */
@U_INLINE void @P_sin_cos_of_four(double a, double b, double c, double d, int n, double *sines, double *cosines) {
#if @U_VECTOR
    const @T_v x = {a, b, c, d};
    @T_v s, t;
    (void)n;
    @T_sin_cos(&x, &s, &t);
    for (int i = 0; i < 4; i++) {
        sines[i] = s[i];
        cosines[i] = t[i];
    }
#else
    const double x[4] = {a, b, c, d};
    for (int i = 0; i < n; i++) {
        sines[i] = @MATH_SIN(x[i]);
        cosines[i] = @MATH_COS(x[i]);
    }
#endif
}

";

/// States one after the other, and a block with each number of all its states together.
const TILES: &str = "\
#if @U_LIMBS
typedef @REAL @T_t __attribute__((vector_size(@TILE)));
typedef @REAL @T_tu __attribute__((vector_size(@TILE), aligned(@BYTES), may_alias));
/* Four numbers of four states: rows become columns. */
@U_INLINE void @T_turn(const @REAL *from, size_t row, @REAL *to, size_t column) {
    const @T_t a = (@T_t)*(const @T_tu *)(const void *)from;
    const @T_t b = (@T_t)*(const @T_tu *)(const void *)(from + row);
    const @T_t c = (@T_t)*(const @T_tu *)(const void *)(from + 2 * row);
    const @T_t d = (@T_t)*(const @T_tu *)(const void *)(from + 3 * row);
    const @T_t p = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const @T_t q = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const @T_t r = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const @T_t s = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    *(@T_tu *)(void *)to = (@T_tu)__builtin_shufflevector(p, r, 0, 1, 4, 5);
    *(@T_tu *)(void *)(to + column) = (@T_tu)__builtin_shufflevector(q, s, 0, 1, 4, 5);
    *(@T_tu *)(void *)(to + 2 * column) = (@T_tu)__builtin_shufflevector(p, r, 2, 3, 6, 7);
    *(@T_tu *)(void *)(to + 3 * column) = (@T_tu)__builtin_shufflevector(q, s, 2, 3, 6, 7);
}
#else
@U_INLINE void @T_turn(const @REAL *from, size_t row, @REAL *to, size_t column) {
    for (size_t i = 0; i < 4; i++) {
        for (size_t k = 0; k < 4; k++) {
            to[k * column + i] = from[i * row + k];
        }
    }
}
#endif
/* At most @BLOCK states of n numbers as a block; the last one fills it. */
@U_INLINE void @T_gather(const @REAL *states, size_t count, size_t n, @REAL *block) {
    if (count == @BLOCK && n >= 4) {
        for (size_t i = 0; i < @BLOCK; i += 4) {
            for (size_t k = 0; k < n; k += 4) {
                /* The last tile is full too: some numbers are in two. */
                const size_t at = k + 4 <= n ? k : n - 4;
                @T_turn(states + i * n + at, n, block + @BLOCK * at + i, @BLOCK);
            }
        }
        return;
    }
    for (size_t i = 0; i < @BLOCK; i++) {
        for (size_t k = 0; k < n; k++) {
            block[@BLOCK * k + i] = states[(i < count ? i : count - 1) * n + k];
        }
    }
}
/* The first states of a block. */
@U_INLINE void @T_scatter(const @REAL *block, @REAL *states, size_t count, size_t n) {
    if (count == @BLOCK && n >= 4) {
        for (size_t i = 0; i < @BLOCK; i += 4) {
            for (size_t k = 0; k < n; k += 4) {
                const size_t at = k + 4 <= n ? k : n - 4;
                @T_turn(block + @BLOCK * at + i, @BLOCK, states + i * n + at, n);
            }
        }
        return;
    }
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < n; k++) {
            states[i * n + k] = block[@BLOCK * k + i];
        }
    }
}

";
