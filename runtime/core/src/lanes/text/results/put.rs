
four_functions! {
    pub(super) fn put_one(x: Real, to: &mut [::core::mem::MaybeUninit<Real>], at: usize) {
        to[at].write(x);
    }

    pub(super) fn put_two(x: [Real; 2], to: &mut [::core::mem::MaybeUninit<Real>], at: usize) {
        if let ::core::option::Option::Some(to) = to[at..at + 2].first_chunk_mut() {
            *to = x.map(::core::mem::MaybeUninit::new);
        }
    }

    pub(super) fn put(x: V, to: &mut [::core::mem::MaybeUninit<Real>], at: usize) {
        let x = array(x);
        if let ::core::option::Option::Some(to) = to[at..at + x.len()].first_chunk_mut() {
            *to = x.map(::core::mem::MaybeUninit::new);
        }
    }
}
