
lane_functions! {
    pub(super) fn load(from: &[Real; LANES]) -> V {
        lanes(*from)
    }

    pub(super) fn store(x: V, to: &mut [Real; LANES]) {
        *to = array(x);
    }

    pub(super) fn lane<const K: usize>(x: V) -> Real {
        array(x)[K]
    }

    pub(super) fn any(m: M) -> bool {
        !within(select(m, k(1.0), k(0.0)), k(0.5))
    }

    pub(super) fn atan2(y: V, x: V) -> V {
        let (mut angles, x) = (array(y), array(x));
        atan2_each(&mut angles, &x);
        lanes(angles)
    }
}

#[inline(never)]
fn atan2_each(y: &mut [Real; LANES], x: &[Real; LANES]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y = y.atan2(*x);
    }
}

#[cold]
#[inline(never)]
fn sin_cos_beyond(x: &[Real; LANES], sin: &mut [Real; LANES], cos: &mut [Real; LANES]) {
    for ((x, sin), cos) in x.iter().zip(sin).zip(cos) {
        if !(f64::from(x.abs()) <= LIMIT) {
            (*sin, *cos) = x.sin_cos();
        }
    }
}
