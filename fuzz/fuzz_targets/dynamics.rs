//! A robot that reads is a model, and what is computed of it is finite or an error.
#![no_main]

use articulated_codegen::model_pass::{View, model_passes};
use articulated_codegen::{Request, generate};
use articulated_core::algorithm::{FunctionId, Workspace, checked_forward_dynamics};
use articulated_core::description::Base;
use articulated_core::model::Model;
use articulated_formats::{Options, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(reading) = read(bytes, &Options::default()) else { return };
    for base in [Base::Fixed, Base::Floating] {
        let Ok(model) = Model::new(&reading.description, base) else { return };
        if model.nv() > 60 {
            return;
        }
        let passed = model_passes::<f64>().iter().fold(View::new(model.clone()), |view, (_, pass, _)| pass(view));
        let mut q = vec![0.3; model.nq()];
        articulated_core::algorithm::neutral(&model, &mut q);
        let (one, mut out) = (vec![0.5; model.nv()], vec![0.0; model.nv()]);
        let mut ws = Workspace::new(&model);
        let row = FunctionId::inverse_dynamics.row::<f64>();
        passed.call_by(row, &row.ways[0], &[&q, &one, &one], &mut out).unwrap();
        if checked_forward_dynamics(&model, &mut ws, &q, &one, &one, &mut out).is_ok() {
            assert!(out.iter().all(|x| x.is_finite()));
        }
    }
    if bytes.len() < 4000 {
        let mut request = Request::new("fuzz.urdf", bytes.to_vec());
        request.options.functions = vec!["inverse_dynamics".into(), "forward_dynamics".into()];
        let _ = generate(&request).map(|g| g.tokens());
    }
});
