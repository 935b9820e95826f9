//! Constants of the model that stay inputs.

use articulated::{Dynamics, Model};
use articulated_core::algorithm::{FunctionId, Workspace};
use articulated_core::description::{Base, Description, Origin, Payload};
use articulated_core::effect::{Applied, EffectId};
use articulated_tests::case::read;

use crate::choices::{A, Q, URDF, V, same, states};

articulated::robot! {
    /// Parameters that are known only at run time.
    mod tuned {
        urdf = "robots/arm.urdf",
        functions = [inverse_dynamics, forward_dynamics, mass_matrix, potential_energy, placements],
        parameters = [payload(tool), inertia("fore"), origin(wrist)],
        batch = [f64, f32],
    }
}

articulated::robot! {
    /// Gravity and a damper that are known only at run time.
    mod elsewhere {
        urdf = "robots/arm.urdf",
        functions = [inverse_dynamics],
        effects = { damping = { elbow = 0.5, wrist = 0.1 } },
        parameters = [gravity, damping(elbow)],
    }
}

/// Numbers that differ from the URDF's: payload, inertia of the forearm, origin of the wrist.
fn changed() -> ([f64; tuned::PARAMETERS.len()], Description) {
    let mut description = read(URDF);
    let payload = Payload {
        link: "tool".into(),
        name: None,
        mass: 0.8,
        center_of_mass: [0.02, -0.01, 0.09],
        inertia: [0.003, 0.0001, -0.0002, 0.002, 0.0003, 0.0015],
    };
    description.attach(&payload).unwrap();
    let fore = description.link("fore").unwrap();
    let inertial = description.links[fore].inertial.as_mut().unwrap();
    (inertial.mass, inertial.origin.xyz) = (1.9, [0.01, 0.0, 0.2]);
    let wrist = description.joint("wrist").unwrap();
    description.joints[wrist].origin.xyz = [0.03, -0.02, 0.4];
    let mut parameters = tuned::PARAMETERS;
    let added = about_origin(payload.mass, payload.center_of_mass, payload.inertia);
    parameters[tuned::parameter::TOOL_PAYLOAD..][..10].copy_from_slice(&added);
    let fore = about_origin(1.9, [0.01, 0.0, 0.2], [0.0159, 0.0, 0.0, 0.0159, 0.0, 0.0012]);
    parameters[tuned::parameter::FORE_INERTIA..][..10].copy_from_slice(&fore);
    parameters[tuned::parameter::WRIST_ORIGIN..][..3].copy_from_slice(&[0.03, -0.02, 0.4]);
    (parameters, description)
}

/// m, m c and I_c + m (cᵀc·1 − c cᵀ).
fn about_origin(m: f64, c: [f64; 3], i: [f64; 6]) -> [f64; 10] {
    let [x, y, z] = c;
    let steiner = [y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y];
    let about: Vec<f64> = i.iter().zip(steiner).map(|(i, s)| i + m * s).collect();
    [vec![m, m * x, m * y, m * z], about].concat().try_into().unwrap()
}

fn holds(parameters: &[f64; tuned::PARAMETERS.len()], description: &Description) {
    let model = Model::new(description, Base::Fixed).unwrap();
    let links = model.frames().iter().take(tuned::FRAMES).map(|f| f.name.clone()).collect::<Vec<_>>();
    let model = model.with_frames(&links).unwrap();
    let generic = |id: FunctionId, arguments: &[&[f64]]| {
        let mut out = vec![0.0; id.row::<f64>().len(model.shape())];
        id.row().call(&model, &mut Workspace::new(&model), arguments, &mut out).unwrap();
        out
    };
    same(&tuned::inverse_dynamics(&Q, &V, &A, parameters), &generic(FunctionId::inverse_dynamics, &[&Q, &V, &A]));
    same(tuned::mass_matrix(&Q, parameters).as_flattened(), &generic(FunctionId::mass_matrix, &[&Q]));
    same(&[tuned::potential_energy(&Q, parameters)], &generic(FunctionId::potential_energy, &[&Q]));
    same(tuned::placements(&Q, parameters).as_flattened(), &generic(FunctionId::placements, &[&Q]));
    let torques = [1.0, -2.0, 0.5];
    let accelerations = generic(FunctionId::forward_dynamics, &[&Q, &V, &torques]);
    let found = tuned::forward_dynamics(&Q, &V, &torques, parameters);
    let size = accelerations.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    assert!(found.iter().zip(&accelerations).all(|(f, e)| (f - e).abs() <= 1e-12 * size), "{found:?} {accelerations:?}");
}

#[test]
fn parameters_that_are_the_urdfs_give_the_robot_of_the_urdf() {
    holds(&tuned::PARAMETERS, &read(URDF));
}

#[test]
fn other_parameters_give_another_robot() {
    let (parameters, description) = changed();
    holds(&parameters, &description);
}

#[test]
fn gravity_and_numbers_of_effects_are_inputs_where_they_are_asked_for() {
    assert_eq!(elsewhere::PARAMETERS, [0.0, 0.0, -9.81, 0.5]);
    let mut parameters = elsewhere::PARAMETERS;
    parameters[elsewhere::parameter::GRAVITY..][..3].copy_from_slice(&[0.4, -0.2, -1.62]);
    parameters[elsewhere::parameter::ELBOW_DAMPING] = 2.0;
    let damping =
        |on: &str, number: f64| Applied { effect: EffectId::damping, on: on.into(), at: Origin::default(), parameters: vec![number] };
    for (parameters, gravity, number) in [(elsewhere::PARAMETERS, [0.0, 0.0, -9.81], 0.5), (parameters, [0.4, -0.2, -1.62], 2.0)] {
        let model = Model::new(&read(URDF), Base::Fixed).unwrap().with_gravity(gravity);
        let model = model.with_effects(&[damping("elbow", number), damping("wrist", 0.1)]).unwrap();
        let mut expected = [0.0; 3];
        model.inverse_dynamics(&mut Workspace::new(&model), &Q, &V, &A, &mut expected).unwrap();
        same(&elsewhere::inverse_dynamics(&Q, &V, &A, &parameters), &expected);
    }
}

/// For one state, for fewer and more than a block, and for none.
#[test]
fn states_of_a_batch_have_parameters_of_their_own_or_one_set_for_all() {
    use tuned::batch_f64::{Lanes, LengthError};
    type Parameters = [f64; tuned::PARAMETERS.len()];
    let (changed, _) = changed();
    for n in [0, 1, 2, 7, 8, 9, 17] {
        let [q, v, a] = [1, 101, 211].map(|salt| states(n, salt));
        let between =
            |part: f64| -> Parameters { std::array::from_fn(|k| tuned::PARAMETERS[k] + part * (changed[k] - tuned::PARAMETERS[k])) };
        let own: Vec<Parameters> = (0..n).map(|i| between(i as f64 / 16.0)).collect();
        for parameters in [&own[..], &[changed]] {
            let of = |i: usize| parameters[if parameters.len() == 1 { 0 } else { i }];
            let (mut tau, mut energy) = (vec![[f64::NAN; 3]; n], vec![f64::NAN; n]);
            tuned::batch_f64::inverse_dynamics(&q, &v, &a, parameters, &mut tau).unwrap();
            tuned::batch_f64::potential_energy(&q, parameters, &mut energy).unwrap();
            let mut blocks = vec![[Lanes::ZERO; 3]; Lanes::blocks(n)];
            let [q_blocks, v_blocks, a_blocks] = [&q, &v, &a].map(|x| {
                let mut packed = blocks.clone();
                Lanes::pack(x, &mut packed).unwrap();
                packed
            });
            let of_blocks: Vec<[Lanes; tuned::PARAMETERS.len()]> = if parameters.len() == 1 {
                vec![parameters[0].map(|x| Lanes([x; Lanes::LEN]))]
            } else {
                let mut packed = vec![[Lanes::ZERO; tuned::PARAMETERS.len()]; blocks.len()];
                Lanes::pack(parameters, &mut packed).unwrap();
                packed
            };
            tuned::batch_f64::inverse_dynamics_blocks(&q_blocks, &v_blocks, &a_blocks, &of_blocks, &mut blocks).unwrap();
            let mut unpacked = tau.clone();
            Lanes::unpack(&blocks, &mut unpacked).unwrap();
            assert_eq!(unpacked, tau);
            for i in 0..n {
                same(&tau[i], &tuned::inverse_dynamics(&q[i], &v[i], &a[i], &of(i)));
                same(&[energy[i]], &[tuned::potential_energy(&q[i], &of(i))]);
            }
        }
        let wrong = tuned::batch_f64::potential_energy(&q, &vec![changed; n + 2], &mut vec![0.0; n]);
        assert_eq!(wrong, Err(LengthError { argument: "parameters", found: n + 2, expected: n }));
    }
    let single = tuned::PARAMETERS.map(|x| x as f32);
    let mut energy = [0.0; 1];
    tuned::batch_f32::potential_energy(&[Q.map(|x| x as f32)], &[single], &mut energy).unwrap();
    assert!((f64::from(energy[0]) - tuned::potential_energy(&Q, &tuned::PARAMETERS)).abs() < 1e-5);
}

#[test]
fn a_robot_over_the_trait_has_its_parameters_with_it() {
    let (parameters, _) = changed();
    let mut out = [0.0; 3];
    for robot in [tuned::Robot::default(), tuned::Robot { parameters }] {
        robot.inverse_dynamics(&mut (), &Q, &V, &A, &mut out).unwrap();
        assert_eq!(out, tuned::inverse_dynamics(&Q, &V, &A, &robot.parameters));
    }
}
