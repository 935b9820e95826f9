//! Two robots in one crate, one of them twice, one in a function, one from a macro of the user's.

articulated::robot! { pub mod arm { urdf = "urdf/arm.urdf" } }

mod inner {
    articulated::robot! { pub(crate) mod arm { urdf = "urdf/arm.urdf", base = floating } }
}

macro_rules! robot {
    ($name:ident, $urdf:literal) => {
        articulated::robot! { mod $name { urdf = $urdf, functions = [] } }
    };
}
robot!(names, "urdf/names.urdf");

fn main() {
    articulated::robot! { mod odd { urdf = "urdf/odd.urdf", standalone = true } }
    assert_eq!((arm::NQ, inner::arm::NQ, names::NQ, odd::NQ), (2, 9, 2, 1));
    assert_eq!(odd::WARNINGS.len(), 1);
    let placements = odd::placements(&[0.0]);
    assert_eq!(placements[odd::frame::BASE], placements[odd::frame::TIP]);
}
