//! Tables with a cubic spline between their rows.

use articulated_core::control::{Aim, Controller, Interpolation};
use articulated_core::model::Model;
use articulated_formats::{Options, read};
use articulated_scene::Scene;

const ARM: &str = "<robot name='r'><link name='b'/><link name='l'><inertial><mass value='1'/>\
    <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
    <joint name='elbow' type='continuous'><parent link='b'/><child link='l'/></joint></robot>";

fn model(base: articulated_core::description::Base) -> Model<f64> {
    let options = Options { base, ..Options::default() };
    Model::new(&read(ARM.as_bytes(), &options).unwrap().description, base).unwrap()
}

fn scene(columns: &str) -> Scene {
    let rows = "rows = [[0, 1], [1, 3], [2, 0]]";
    Scene::read("s.toml", &format!("[control]\nkind = 'pd'\nkp = 1\ninterpolation = 'cubic'\ncolumns = ['{columns}']\n{rows}")).unwrap()
}

#[test]
fn targets_may_be_a_cubic_spline() {
    let fixed = model(articulated_core::description::Base::Fixed);
    let Controller::Pd { target: Aim::Moving(series), .. } = scene("elbow").controller(&fixed, &mut |_| Err(String::new())).unwrap() else {
        panic!("a controller that follows a table")
    };
    assert!(matches!(&series.between, Interpolation::Cubic(rates) if rates[0] == [0.0] && rates[2] == [0.0] && rates[1] != [0.0]));
}

#[test]
fn targets_with_quaternions_may_not() {
    let floating = model(articulated_core::description::Base::Floating);
    let told = scene("elbow").controller(&floating, &mut |_| Err(String::new())).unwrap_err().to_string();
    let expected =
        "s.toml:4: control.interpolation: found \"cubic\" for targets of 8 coordinates with quaternions, expected \"linear\" or \"hold\"";
    assert_eq!(told, expected);
}
