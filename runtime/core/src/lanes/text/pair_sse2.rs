macro_rules! lane_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "sse2")] $item)* };
}

