
// Angles to 384 bits in whole numbers (Payne & Hanek 1983): any double's quadrant and rest, and its
// sine and cosine where two doubles do not decide.

/// Fractions of one in words, the first the highest.
type Fraction = [u64; 6];

/// 2/π, 1408 bits.
const TWO_OVER_PI: [u64; 22] = [
    0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561, 0xb7246e3a424dd2e0, 0x06492eea09d1921c,
    0xfe1deb1cb129a73e, 0xe88235f52ebb4484, 0xe99c7026b45f7e41, 0x3991d639835339f4, 0x9c845f8bbdf9283b, 0x1ff897ffde05980f,
    0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7, 0x4f463f669e5fea2d, 0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08,
    0x56033046fc7b6bab, 0xf0cfbc209af4361d, 0xa9e391615ee61b08, 0x6599855f14a06840,
];

/// π/4.
const QUARTER_PI: Fraction =
    [0xc90fdaa22168c234, 0xc4c6628b80dc1cd1, 0x29024e088a67cc74, 0x020bbea63b139b22, 0x514a08798e3404dd, 0xef9519b3cd3a431b];

/// x = n·π/2 ± rest, the rest in [0, π/4].
struct Turned {
    quadrant: u64,
    negative: bool,
    rest: Fraction,
}

/// Of a finite x that is not subnormal, |x| ≥ 2⁻²⁸; errors of 2⁻³⁸⁰.
fn turned_back(x: f64) -> Turned {
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i64 - 1075;
    let mantissa = (bits & 0xfffffffffffff) | 0x10000000000000;
    // The bits of 2/π from weight 2 on times the mantissa, modulo 4: of what is above only
    // multiples of 4 come.
    let mut product = [0_u64; 7];
    let mut carry = 0_u128;
    let mut i = 7;
    while i > 0 {
        i -= 1;
        let sum = word_from(exponent - 2 + 64 * i as i64) as u128 * mantissa as u128 + carry;
        product[i] = sum as u64;
        carry = sum >> 64;
    }
    let mut quadrant = product[0] >> 62;
    let mut part = [0; 6];
    i = 0;
    while i < 6 {
        part[i] = product[i] << 2 | product[i + 1] >> 62;
        i += 1;
    }
    let over = part[0] >> 63 == 1;
    if over {
        quadrant += 1;
        part = minus(&part);
    }
    let rest = doubled(&product_of(&part, &QUARTER_PI));
    // Of −x all with the other sign.
    match x < 0.0 {
        true => Turned { quadrant: quadrant.wrapping_neg() & 3, negative: !over, rest },
        false => Turned { quadrant: quadrant & 3, negative: over, rest },
    }
}

/// 64 bits of 2/π from bit number `at` on, the first behind the point being 0.
fn word_from(at: i64) -> u64 {
    let word = |k: i64| if k >= 0 && k < 22 { TWO_OVER_PI[k as usize] } else { 0 };
    let (place, shift) = (at.div_euclid(64), at.rem_euclid(64));
    if shift == 0 { word(place) } else { word(place) << shift | word(place + 1) >> (64 - shift) }
}

/// 1 − x, for x > 0.
fn minus(x: &Fraction) -> Fraction {
    let mut out = [0; 6];
    let mut carry = true;
    let mut i = 6;
    while i > 0 {
        i -= 1;
        let (word, over) = (!x[i]).overflowing_add(carry as u64);
        (out[i], carry) = (word, over);
    }
    out
}

fn doubled(x: &Fraction) -> Fraction {
    let mut out = [0; 6];
    let mut i = 0;
    while i < 6 {
        out[i] = x[i] << 1 | if i < 5 { x[i + 1] >> 63 } else { 0 };
        i += 1;
    }
    out
}

/// a b, cut off.
fn product_of(a: &Fraction, b: &Fraction) -> Fraction {
    let mut out = [0_u64; 12];
    let mut i = 6;
    while i > 0 {
        i -= 1;
        let mut carry = 0_u128;
        let mut j = 6;
        while j > 0 {
            j -= 1;
            let sum = a[i] as u128 * b[j] as u128 + out[i + j + 1] as u128 + carry;
            out[i + j + 1] = sum as u64;
            carry = sum >> 64;
        }
        out[i] = carry as u64;
    }
    [out[0], out[1], out[2], out[3], out[4], out[5]]
}

fn over(x: &Fraction, divisor: u64) -> Fraction {
    let mut out = [0; 6];
    let mut rest = 0_u128;
    let mut i = 0;
    while i < 6 {
        let part = rest << 64 | x[i] as u128;
        out[i] = (part / divisor as u128) as u64;
        rest = part % divisor as u128;
        i += 1;
    }
    out
}

/// a ± b, modulo 1.
fn sum_of(a: &Fraction, b: &Fraction, subtract: bool) -> Fraction {
    let mut out = [0; 6];
    let mut carry = subtract;
    let mut i = 6;
    while i > 0 {
        i -= 1;
        let sum = a[i] as u128 + if subtract { !b[i] } else { b[i] } as u128 + carry as u128;
        out[i] = sum as u64;
        carry = sum >> 64 != 0;
    }
    out
}

fn is_nothing(x: &Fraction) -> bool {
    x[0] | x[1] | x[2] | x[3] | x[4] | x[5] == 0
}

/// first − first·z/((n+1)(n+2)) + …
fn series(first: &Fraction, z: &Fraction, mut n: u64) -> Fraction {
    let (mut sum, mut term, mut subtract) = (*first, *first, true);
    while !is_nothing(&term) {
        term = over(&product_of(&term, z), (n + 1) * (n + 2));
        sum = sum_of(&sum, &term, subtract);
        (n, subtract) = (n + 2, !subtract);
    }
    sum
}

/// The first 64 bits that count and those behind them, and how many zeros stand before.
fn head(x: &Fraction) -> (u64, u64, i32) {
    let mut i = 0;
    while i < 5 && x[i] == 0 {
        i += 1;
    }
    let word = |k: usize| if k < 6 { x[k] } else { 0 };
    let zeros = word(i).leading_zeros();
    let at = |k: usize| if zeros == 0 { word(k) } else { (word(k) << (zeros & 63)) | (word(k + 1) >> (64 - zeros)) };
    if word(i) == 0 { (0, 0, 384) } else { (at(i), at(i + 1), 64 * i as i32 + zeros as i32) }
}

/// 2ⁿ, −1022 ≤ n ≤ 1023.
fn power(n: i32) -> f64 {
    f64::from_bits(((n + 1023) as u64) << 52)
}

/// The nearest double.
fn nearest(x: &Fraction) -> f64 {
    let (first, second, zeros) = head(x);
    (first | (second != 0) as u64) as f64 * power(-64 - zeros)
}

/// As a sum of two doubles.
fn two_parts(x: &Fraction) -> (f64, f64) {
    let (first, second, zeros) = head(x);
    let high = (first >> 11 << 11) as f64 * power(-64 - zeros);
    let low = (((first & 0x7ff) << 53) | (second >> 11)) as f64 * power(-117 - zeros);
    fast_two_sum(high, low)
}

/// (sin x, cos x), the doubles nearest to them, of a finite x with |x| ≥ 2⁻²⁸.
#[cold]
#[inline(never)]
pub(super) fn sines_in_whole_numbers(x: f64) -> (f64, f64) {
    let Turned { quadrant, negative, rest } = turned_back(x);
    let z = product_of(&rest, &rest);
    let sin = nearest(&series(&rest, &z, 1));
    // 1 − cos = z/2 − z²/4! + …
    let less = series(&over(&z, 2), &z, 2);
    let cos = if is_nothing(&less) { 1.0 } else { nearest(&minus(&less)) };
    let sin = if negative { -sin } else { sin };
    match quadrant & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}
