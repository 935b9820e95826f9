//! Shafts that bend, against the beam of Euler and Bernoulli.

use articulated_core::description::{Base, Description, EditError, Inertial, Joint, JointId, JointKind, Link, LinkId, Origin, Shaft};
use articulated_core::effect::EffectId;
use articulated_core::model::Model;
use articulated_test_support::case::{inverse_dynamics, mass_matrix, placements};

const LENGTH: f64 = 1.2;
const STIFFNESS: f64 = 40.0;

/// A link held by the base's only joint, a fixed joint, and what hangs on it. The joint's offset is
/// `along`.
fn rod(along: [f64; 3], head: f64) -> Description {
    let link = |name: &str, mass: f64| Link {
        name: name.into(),
        inertial: (mass > 0.0).then(|| Inertial { origin: Origin::default(), mass, inertia: [0.0; 6] }),
        ..Link::default()
    };
    let joint = Joint {
        name: "hosel".into(),
        parent: LinkId(0),
        child: LinkId(1),
        origin: Origin::new(along, [0.1, 0.2, 0.3]),
        ..Joint::default()
    };
    Description { name: "rod".into(), links: [link("grip", 0.25), link("head", head)].into(), joints: [joint].into(), frames: Vec::new() }
}

fn shaft(segments: usize, mass: f64) -> Shaft {
    Shaft { joint: "hosel".into(), segments, stiffness: STIFFNESS, damping: 0.01, mass: Some(mass), ..Shaft::default() }
}

/// The model and the stiffness of its joints.
fn bending(along: [f64; 3], head: f64, shaft: &Shaft) -> (Model<f64>, f64) {
    let mut description = rod(along, head);
    let applied = description.shaft(shaft).unwrap();
    let n = shaft.segments;
    assert!(applied[..n].iter().all(|a| a.effect == EffectId::spring && a.parameters == [applied[0].parameters[0], 0.0]));
    assert!(applied[n..].iter().all(|a| a.effect == EffectId::damping && a.parameters == [applied[0].parameters[0] * shaft.damping]));
    assert_eq!(applied.len(), 2 * n);
    (Model::new(&description, Base::Fixed).unwrap().with_effects(&applied).unwrap(), applied[0].parameters[0])
}

/// Where the head is, m.
fn head(model: &Model<f64>, q: &[f64]) -> [f64; 3] {
    let frame = model.frames().iter().position(|f| f.name == "head").unwrap();
    let all = placements(model, q);
    let per = all.len() / model.frames().len();
    let one = &all[frame * per..(frame + 1) * per];
    // Rotation by rows, then the position.
    [one[per - 3], one[per - 2], one[per - 1]]
}

#[test]
fn a_straight_shaft_leaves_everything_where_it_was() {
    for along in [[0.0, 0.0, -LENGTH], [0.3, 0.0, -1.1], [0.2, -0.4, 0.7], [LENGTH, 0.0, 0.0]] {
        let (model, _) = bending(along, 0.2, &Shaft { start: Some([0.0, 0.0, -0.05]), end: Some([0.0, 0.1, -0.8]), ..shaft(5, 0.06) });
        let before = Model::new(&rod(along, 0.2), Base::Fixed).unwrap();
        let (found, expected) = (head(&model, &[0.0; 10]), head(&before, &[]));
        // A few roundings for each of the turns to and from the five joints' axes.
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 32.0 * f64::EPSILON), "{found:?} {expected:?}");
        assert!((model.moving_mass() - 0.2 - 0.06 * 0.9).abs() < 1e-15);
    }
}

/// A force f across the end turns each joint by f·(its distance to the end)/k; the end deflects by
/// f L³/(3 E I), less a part ¼/n².
#[test]
fn the_end_gives_way_as_that_of_a_beam_but_for_a_quarter_of_n_squared() {
    for n in [1, 2, 3, 8, 20] {
        let (model, k) = bending([0.0, 0.0, -LENGTH], 0.2, &shaft(n, 0.06));
        // d(end)/dq, by a step whose error is only its square.
        let step = 1e-6;
        let slope = |i: usize| {
            let at = |x: f64| {
                let mut q = vec![0.0; model.nq()];
                q[i] = x;
                head(&model, &q)
            };
            let (a, b) = (at(step), at(-step));
            [0, 1].map(|axis| (a[axis] - b[axis]) / (2.0 * step))
        };
        let slopes: Vec<[f64; 2]> = (0..model.nq()).map(slope).collect();
        for axis in [0, 1] {
            // q = Jᵀ f / k, δ = J q
            let deflection: f64 = slopes.iter().map(|s| s[axis] * s[axis] / k).sum();
            let expected = LENGTH.powi(3) / (3.0 * STIFFNESS) * (1.0 - 0.25 / (n * n) as f64);
            assert!((deflection / expected - 1.0).abs() < 1e-9, "n = {n}: {deflection} {expected}");
        }
    }
}

/// ω₁ = 1.875104² √(E I/(m L³)) of a beam that is clamped at one end. The error falls with the
/// square of the number of pieces.
#[test]
fn the_lowest_frequency_becomes_that_of_a_beam() {
    let mass = 0.3;
    let beam = 1.875_104_068_711_961f64.powi(2) * (STIFFNESS / (mass * LENGTH.powi(3))).sqrt();
    let error = |n: usize| {
        let (model, k) = bending([0.0, 0.48 * 2.0, -0.36 * 2.0], 0.0, &shaft(n, mass));
        let m = mass_matrix(&model, &vec![0.0; model.nq()]);
        let largest = m.symmetric_eigenvalues().max();
        (k / largest).sqrt() / beam - 1.0
    };
    let (coarse, fine) = (error(6), error(12));
    assert!(fine.abs() < 2e-3 && (coarse / fine - 4.0).abs() < 0.2, "{coarse} {fine}");
}

/// Whatever its direction, a rod has m ℓ²/12 about its middle across it, and zero about itself.
#[test]
fn rods_are_thin() {
    let mut description = rod([0.3, -0.5, 0.7], 0.2);
    description.shaft(&shaft(3, 0.06)).unwrap();
    for link in description.links.iter().skip(2) {
        let Inertial { origin, mass, inertia: [xx, xy, xz, yy, yz, zz] } = link.inertial.unwrap();
        let [x, y, z] = origin.xyz;
        let across = mass * (x * x + y * y + z * z) / 3.0;
        let about_itself = [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z];
        assert!(about_itself.iter().all(|m| m.abs() < 1e-15 * across), "{}: {about_itself:?}", link.name);
        assert!((xx + yy + zz - 2.0 * across).abs() < 1e-15 * across && xx > 0.0 && yy > 0.0 && zz > 0.0, "{}", link.name);
    }
}

/// τ = k q on each of the 2n coordinates, and E I damping/ℓ times the rate.
#[test]
fn every_joint_has_its_springs_in_both_directions() {
    let (model, k) = bending([0.0, 0.0, -LENGTH], 0.2, &shaft(3, 0.06));
    let still = model.with_gravity([0.0; 3]);
    assert!((k - STIFFNESS / (LENGTH / 3.0)).abs() < 1e-12);
    for i in 0..6 {
        let unit: Vec<f64> = (0..6).map(|j| if i == j { 0.25 } else { 0.0 }).collect();
        let tau = inverse_dynamics(&still, &unit, &[0.0; 6], &[0.0; 6]);
        assert!((0..6).all(|j| (tau[j] - k * unit[j]).abs() < 1e-12 * k), "{tau:?}");
    }
    let tau = inverse_dynamics(&still, &[0.0; 6], &[1e-9; 6], &[0.0; 6]);
    assert!(tau.iter().all(|t| (t / (1e-9 * 0.01 * k) - 1.0).abs() < 1e-6), "{tau:?}");
}

#[test]
fn the_mass_is_that_of_the_link_before_unless_it_is_given() {
    let mut description = rod([0.0, 0.0, -LENGTH], 0.2);
    description.shaft(&Shaft { mass: None, ..shaft(3, 0.0) }).unwrap();
    assert_eq!(description.links[LinkId(0)].inertial, None);
    let rods: f64 = description.links.iter().skip(2).map(|l| l.inertial.unwrap().mass).sum();
    assert!((rods - 0.25).abs() < 1e-15);
    let names: Vec<&str> = description.joints.iter().map(|j| j.name.as_str()).collect();
    assert_eq!(names, ["hosel", "hosel_rod_0", "hosel_1", "hosel_2", "hosel_3"]);
    assert_eq!(description.joints[JointId(0)].kind, JointKind::Fixed);
}

#[test]
fn what_cannot_bend_is_refused_and_nothing_is_changed() {
    let plain = rod([0.0, 0.0, -LENGTH], 0.2);
    let refused = |change: &dyn Fn(&mut Shaft)| {
        let (mut description, mut asked) = (plain.clone(), shaft(2, 0.1));
        change(&mut asked);
        let error = description.shaft(&asked).unwrap_err();
        assert_eq!(description, plain, "{error}");
        error
    };
    let field = |change: &dyn Fn(&mut Shaft)| match refused(change) {
        EditError::ShaftNumber { field, .. } => field,
        other => panic!("{other}"),
    };
    assert_eq!(field(&|s| s.segments = 0), "segments");
    assert_eq!(field(&|s| s.stiffness = f64::NAN), "stiffness");
    assert_eq!(field(&|s| s.damping = -1.0), "damping");
    assert_eq!(field(&|s| s.mass = Some(0.0)), "mass");
    assert_eq!(field(&|s| s.end = Some([0.0; 3])), "length");
    assert_eq!(field(&|s| s.start = Some([f64::INFINITY, 0.0, 0.0])), "length");
    assert!(matches!(refused(&|s| s.joint = "hosl".into()), EditError::UnknownJoint { nearest: Some(near), .. } if near == "hosel"));
    let mut twice = plain.clone();
    twice.shaft(&shaft(2, 0.1)).unwrap();
    assert!(matches!(twice.shaft(&shaft(2, 0.1)), Err(EditError::NamesTaken { names }) if names.len() == 6));
    assert!(matches!(twice.shaft(&Shaft { joint: "hosel_1".into(), ..shaft(2, 0.1) }), Err(EditError::ShaftNotFixed { .. })));
}
