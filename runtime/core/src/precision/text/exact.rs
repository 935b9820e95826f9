// Sums and products without error: the nearest double and what it lost. This text and those beside
// it are compiled and tested in the runtime and copied into generated code; they need nothing but
// `std`. FUSED: whether a·b + c is one instruction.

#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    // Knuth, The Art of Computer Programming 2, 4.2.2
    let s = a + b;
    let c = s - a;
    (s, (a - (s - c)) + (b - c))
}

/// |a| ≥ |b|, or a = 0.
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    // Dekker 1971
    let s = a + b;
    (s, b - (s - a))
}

#[inline(always)]
fn multiply_add<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Without a fused instruction: |a|, |b| < 2⁹⁹⁶.
#[inline(always)]
fn two_prod<const FUSED: bool>(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    if FUSED {
        return (p, a.mul_add(b, -p));
    }
    // Dekker 1971, Veltkamp's splitting
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
}

/// x as 26 bits and the rest.
#[inline(always)]
fn halves(x: f64) -> (f64, f64) {
    let t = 134217729.0 * x;
    let high = t - (t - x);
    (high, x - high)
}
