pub(super) const LANES: usize = 8;

macro_rules! each_lane {
    ($i:ident => $value:expr) => {
        [
            { let $i = 0; $value }, { let $i = 1; $value }, { let $i = 2; $value }, { let $i = 3; $value },
            { let $i = 4; $value }, { let $i = 5; $value }, { let $i = 6; $value }, { let $i = 7; $value },
        ]
    };
}
