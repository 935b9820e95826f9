
four_functions! {
    pub(super) fn put_fours(a: V, b: V, c: V, d: V, to: &mut [::core::mem::MaybeUninit<Real>], at: [usize; LANES]) {
        let (a, b, c, d) = (array(a), array(b), array(c), array(d));
        put(lanes([a[0], b[0], c[0], d[0]]), to, at[0]);
        put(lanes([a[1], b[1], c[1], d[1]]), to, at[1]);
        put(lanes([a[2], b[2], c[2], d[2]]), to, at[2]);
        put(lanes([a[3], b[3], c[3], d[3]]), to, at[3]);
    }

    pub(super) fn put_twos(a: V, b: V, to: &mut [::core::mem::MaybeUninit<Real>], at: [usize; LANES]) {
        let (a, b) = (array(a), array(b));
        put_two([a[0], b[0]], to, at[0]);
        put_two([a[1], b[1]], to, at[1]);
        put_two([a[2], b[2]], to, at[2]);
        put_two([a[3], b[3]], to, at[3]);
    }

    pub(super) fn put_in_turn(a: V, b: V, c: V, to: &mut [::core::mem::MaybeUninit<Real>], at: usize) {
        let (a, b, c) = (array(a), array(b), array(c));
        put(lanes([a[0], b[0], c[0], a[1]]), to, at);
        put(lanes([b[1], c[1], a[2], b[2]]), to, at + 4);
        put(lanes([c[2], a[3], b[3], c[3]]), to, at + 8);
    }

    pub(super) fn every_third(x: &[Real; 12]) -> [V; 3] {
        [lanes([x[0], x[3], x[6], x[9]]), lanes([x[1], x[4], x[7], x[10]]), lanes([x[2], x[5], x[8], x[11]])]
    }

    // The sums of the lanes of each, added up as by `reduce_add`.
    pub(super) fn reduce_add_of_four(a: V, b: V, c: V, d: V) -> V {
        let sum = |[a, b, c, d]: [Real; LANES]| (a + b) + (c + d);
        lanes([sum(array(a)), sum(array(b)), sum(array(c)), sum(array(d))])
    }

    // Those of two, twice.
    pub(super) fn reduce_add_of_two(a: V, b: V) -> V {
        reduce_add_of_four(a, b, a, b)
    }
}
