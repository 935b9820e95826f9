pub(super) const LANES: usize = 4;

macro_rules! each_lane {
    ($i:ident => $value:expr) => {
        [{ let $i = 0; $value }, { let $i = 1; $value }, { let $i = 2; $value }, { let $i = 3; $value }]
    };
}

macro_rules! four_functions {
    ($($item:item)*) => { $(#[inline(always)] $item)* };
}
