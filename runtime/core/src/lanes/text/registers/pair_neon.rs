macro_rules! four_functions {
    ($($item:item)*) => { $(#[inline] #[target_feature(enable = "neon")] $item)* };
}

