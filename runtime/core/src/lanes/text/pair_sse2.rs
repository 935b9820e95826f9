macro_rules! pair_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "sse2")] $item)* };
}

