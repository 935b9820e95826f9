
// Sines and cosines of sums of two doubles: reduction by π/2 in five parts, by 1/32 with a table,
// and the series.

/// Up to this |x|, rad, n times one of the first three parts of π/2 is exact.
const NEAR: f64 = 1e6;

/// π/2 in three parts of 33 bits and two of 53: 2⁻²¹³ is left over.
const PARTS: [f64; 5] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21, 8.4784276603689e-32, 7.398504768267704e-49];

/// 1.5·2⁵²: adding it rounds to an integer and leaves that integer in the low bits.
const TO_INTEGER: f64 = 6755399441055744.0;

/// (sin x, cos x), x in rad, any. Error at most 2⁻¹⁰⁰ of each; NaN of what is not finite.
#[inline(never)]
pub(super) fn sines_of_two<const FUSED: bool>(x: (f64, f64)) -> ((f64, f64), (f64, f64)) {
    let (quadrant, r) = if x.0.abs() <= NEAR {
        near::<FUSED>(x)
    } else if x.0.abs() < f64::INFINITY {
        far(x)
    } else {
        return ((f64::NAN, f64::NAN), (f64::NAN, f64::NAN));
    };
    let (s, c) = within::<FUSED>(r);
    match quadrant & 3 {
        0 => (s, c),
        1 => (c, (-s.0, -s.1)),
        2 => ((-s.0, -s.1), (-c.0, -c.1)),
        _ => ((-c.0, -c.1), s),
    }
}

/// n and x − n·π/2.
#[inline(always)]
fn near<const FUSED: bool>(x: (f64, f64)) -> (u64, (f64, f64)) {
    let rounded = x.0 * ::core::f64::consts::FRAC_2_PI + TO_INTEGER;
    let n = rounded - TO_INTEGER;
    // The first step is exact, and so are all sums with what they lost.
    let (b, b_lost) = two_sum(x.0 - n * PARTS[0], -(n * PARTS[1]));
    let (c, c_lost) = two_sum(b, -(n * PARTS[2]));
    let (d, d_lost) = two_prod::<FUSED>(n, PARTS[3]);
    let (t, t_lost) = two_sum(b_lost, c_lost);
    let (u, u_lost) = two_sum(t, -d);
    let (r, r_lost) = two_sum(c, u);
    let (w, w_lost) = two_sum(r_lost, x.1);
    let (r, w) = two_sum(r, w);
    (rounded.to_bits(), two_sum(r, w + (w_lost + (t_lost + (u_lost - (d_lost + n * PARTS[4]))))))
}

/// (sin r, cos r), |r| ≤ π/4 and a little.
#[inline(always)]
fn within<const FUSED: bool>(r: (f64, f64)) -> ((f64, f64), (f64, f64)) {
    let negative = r.0 < 0.0;
    let (r0, r1) = if negative { (-r.0, -r.1) } else { r };
    // r = place/32 + t; the difference is exact.
    let rounded = r0 * 32.0 + TO_INTEGER;
    let place = rounded - TO_INTEGER;
    let t = two_sum(r0 - place * 0.03125, r1);
    let z = times::<FUSED>(t, t);
    // sin t = t + t z (−1/3! + z (1/5! + z (−1/7! + z q)))
    let q = z.0 * (2.7557319223985893e-06 + z.0 * (-2.505210838544172e-08 + z.0 * 1.6059043836821613e-10));
    let p = plus((-0.0001984126984126984, -1.7209558293420705e-22), (q, 0.0));
    let p = plus((0.008333333333333333, 1.1564823173178714e-19), times::<FUSED>(z, p));
    let p = plus((-0.16666666666666666, -9.25185853854297e-18), times::<FUSED>(z, p));
    let sin = plus(t, times::<FUSED>(times::<FUSED>(t, z), p));
    // cos t − 1 = z (−1/2! + z (1/4! + z (−1/6! + z q)))
    let q = z.0 * (2.48015873015873e-05 + z.0 * (-2.755731922398589e-07 + z.0 * 2.08767569878681e-09));
    let p = plus((-0.001388888888888889, 5.300543954373577e-20), (q, 0.0));
    let p = plus((0.041666666666666664, 2.3129646346357427e-18), times::<FUSED>(z, p));
    let p = plus((-0.5, 0.0), times::<FUSED>(z, p));
    let less = times::<FUSED>(z, p);
    // sin(a + t) = sin a + (cos a sin t + sin a (cos t − 1)), and so for the cosine.
    let [s, s1, c, c1] = TURNS[(rounded.to_bits() & 31) as usize];
    let (a, b) = ((s, s1), (c, c1));
    let sine = plus(a, plus(times::<FUSED>(b, sin), times::<FUSED>(a, less)));
    let cosine = plus(b, plus(times::<FUSED>(b, less), times::<FUSED>((-s, -s1), sin)));
    (if negative { (-sine.0, -sine.1) } else { sine }, cosine)
}

/// As in `double_double.rs`.
#[inline(always)]
fn times<const FUSED: bool>(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (p, e) = two_prod::<FUSED>(a.0, b.0);
    let lows = multiply_add::<FUSED>(a.1, b.0, multiply_add::<FUSED>(a.0, b.1, a.1 * b.1));
    fast_two_sum(p, e + lows)
}

/// As in `double_double.rs`.
#[inline(always)]
fn plus(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    let (s, e) = two_sum(a.0, b.0);
    let (t, f) = two_sum(a.1, b.1);
    let (v, w) = fast_two_sum(s, e + t);
    fast_two_sum(v, f + w)
}

/// n and x − n·π/2 of a large x.
#[cold]
#[inline(never)]
fn far(x: (f64, f64)) -> (u64, (f64, f64)) {
    let Turned { quadrant, negative, rest } = turned_back(x.0);
    let (high, low) = two_parts(&rest);
    let r = if negative { (-high, -low) } else { (high, low) };
    (quadrant, plus(r, (x.1, 0.0)))
}

/// sin and cos of k/32.
const TURNS: [[f64; 4]; 32] = [
    [0.0, 0.0, 1.0, 0.0],
    [0.03124491398532608, -1.562781562225433e-18, 0.9995117584851364, -3.418806487972947e-17],
    [0.0624593178423802, -2.040259504585711e-18, 0.9980475107000991, 3.3232291674141346e-17],
    [0.09361273123551289, 1.4628632005878733e-18, 0.9956086864580017, 3.312922430932991e-17],
    [0.12467473338522769, -2.925947496057858e-18, 0.992197667229329, 4.754870575189364e-17],
    [0.15561499277355603, 8.886053372342288e-18, 0.9878177838164719, 4.91917302237681e-17],
    [0.18640329676226988, 2.3493796901281573e-18, 0.9824733131012553, -3.919920375420088e-17],
    [0.21700958109501015, 1.1170071073364376e-17, 0.9761694738686353, -7.850690609285027e-18],
    [0.24740395925452294, -7.53102495590706e-18, 0.9689124217106447, 5.071436662403936e-17],
    [0.2775567516463363, 1.7674070262791822e-17, 0.9607092430155619, -2.807827063516729e-17],
    [0.30743851458038085, 1.1004366442765296e-19, 0.9515679480481722, -3.8614834675674123e-17],
    [0.33702006902225307, 1.0312279860787216e-17, 0.9414974631278811, -4.8523830236797095e-18],
    [0.36627252908604757, -9.938814562106524e-18, 0.9305076219123143, 4.488760003328074e-18],
    [0.39516733024093426, -1.9613487871414228e-17, 0.9186091557949183, -4.0564150104514996e-17],
    [0.42367625720393803, -2.331800700068871e-17, 0.9058136834259364, 4.2864666490805214e-17],
    [0.4517714714916838, -8.234073942098903e-18, 0.8921336993669944, 2.3160655211380166e-17],
    [0.479425538604203, -5.103969860556013e-18, 0.8775825618903728, -4.2623149864279997e-17],
    [0.5066114548142574, -3.269413423618168e-17, 0.8621744799348805, 4.4132427578105805e-18],
    [0.5333026735360201, 5.129318115032044e-17, 0.8459244992310679, 1.549506647350329e-17],
    [0.5594731312473669, 1.575565514488728e-17, 0.8288484876093257, 1.1163935406617444e-17],
    [0.5850972729404622, -5.4883972461161805e-17, 0.8109631195052179, -3.091333486122179e-17],
    [0.6101500770757914, -1.479826990758988e-17, 0.7922858596771786, -2.9049779312834576e-17],
    [0.6346070800152693, -3.4568582392624965e-17, 0.7728349461524715, 4.231014921891023e-17],
    [0.6584443999105676, -3.7736386700306717e-17, 0.7526293724180665, -1.2970993013150526e-17],
    [0.6816387600233341, 4.410467313197903e-17, 0.7316888688738209, -1.0475824306512768e-17],
    [0.7041675114545337, -3.94095700584825e-17, 0.7100338835660797, 1.505272211891291e-17],
    [0.7260086552607126, -1.573621815339587e-17, 0.6876855622205048, 3.5430696752823923e-17],
    [0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0],
];
