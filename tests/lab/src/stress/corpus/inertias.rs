//! Inertias that nearly cancel, or nearly cannot be.

use articulated_core::description::{Base, JointKind, Origin};

use super::Effort;
use crate::stress::judge::{BACKWARD, Ends, Judge};
use crate::stress::robots::{self, Body, Builder, built, states};
use crate::stress::row::{Case, Row};

pub(super) const NAME: &str = "inertias";

const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

pub(super) fn rows(_: Effort) -> Vec<Row> {
    let mut rows = Vec::new();
    for exponent in [-3, -6] {
        rows.extend(far_off(exponent));
    }
    rows.extend(about_its_own_center());
    rows.extend(triangle());
    rows.extend(turned());
    rows
}

/// Its centre of mass 1 m off, a radius of gyration of 1 mm and less.
fn far_off(exponent: i32) -> Vec<Row> {
    let k = 10.0_f64.powi(exponent);
    let case = Case::new(
        NAME,
        format!("radius of gyration 1e{exponent} m, centre of mass 1 m off"),
        "m c² and m k² differ by many digits, and so does their sum from either",
    );
    let model = built(&robots::far_off(k), Base::Fixed);
    let states = states(&model, 4, 21, 1.0);
    let mut rows = Judge::<f64>::new(&case, &model).all(&states, Ends::Solved, BACKWARD);
    rows.extend(Judge::<f32>::new(&case, &model).all(&states, Ends::Either, BACKWARD));
    rows
}

/// A free body with its frame 1 m from its centre of mass: its inertia about that is the difference
/// of two large ones.
fn about_its_own_center() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "a free body whose frame is 1 m off its centre of mass, radius of gyration 1 mm",
        "its inertia about its centre is the rest of a difference",
    );
    let body = Some(Body::of_radii(1.0, [1.0, 0.0, 0.0], [1e-3, 2e-3, 1.5e-3]));
    let model = Builder::new("free").link(None, JointKind::Floating, Z, Origin::default(), body).model();
    Judge::<f64>::new(&case, &model).all(&states(&model, 4, 22, 1.0), Ends::Solved, BACKWARD)
}

fn triangle() -> Vec<Row> {
    let mut rows = Vec::new();
    let plates = [
        ("a plate: xx + yy = zz exactly", [0.02, 0.03, 0.05]),
        ("a rod: xx = 0, yy = zz", [0.0, 0.03, 0.03]),
        ("beyond the triangle inequality by the rounding of a drawing, 1e-6", [0.02, 0.03, 0.050_000_05]),
    ];
    for (name, [xx, yy, zz]) in plates {
        let case = Case::new(NAME, name, "a second moment of mass is zero or a little less than nothing");
        let body = Some(Body { mass: 1.0, center: [0.1, -0.05, 0.02], rpy: [0.0; 3], inertia: [xx, 0.0, 0.0, yy, 0.0, zz] });
        let model = Builder::new("plate")
            .turn(Z, [0.0; 3], body)
            .turn(Y, [0.3, 0.0, 0.1], body)
            .turn([1.0, 0.0, 0.0], [0.2, 0.1, 0.0], body)
            .model();
        rows.extend(Judge::<f64>::new(&case, &model).all(&states(&model, 4, 23, 1.0), Ends::Solved, BACKWARD));
        rows.extend(Judge::<f32>::new(&case, &model).all(&states(&model, 4, 23, 1.0), Ends::Solved, BACKWARD));
    }
    rows
}

/// The same bodies, with inertias given in arbitrarily turned frames.
fn turned() -> Vec<Row> {
    let case = Case::new(
        NAME,
        "inertias in frames that are turned by any angles",
        "a small principal moment is the rest of the large ones after the turn",
    );
    let model = built(&robots::turned(), Base::Fixed);
    let mut rows = Judge::<f64>::new(&case, &model).all(&states(&model, 4, 24, 1.0), Ends::Solved, BACKWARD);
    rows.extend(Judge::<f32>::new(&case, &model).all(&states(&model, 4, 24, 1.0), Ends::Either, BACKWARD));
    rows
}
