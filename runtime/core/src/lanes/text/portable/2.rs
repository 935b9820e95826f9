pub(super) const LANES: usize = 2;

macro_rules! each_lane {
    ($i:ident => $value:expr) => {
        [{ let $i = 0; $value }, { let $i = 1; $value }]
    };
}
