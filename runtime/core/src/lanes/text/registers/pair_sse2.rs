macro_rules! four_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "sse2,fxsr")] $item)* };
}

