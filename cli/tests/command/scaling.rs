use crate::run;

#[test]
fn chains_are_measured_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let chart = folder.path().join("chart.svg");
    let name = chart.to_str().unwrap();
    let words = ["scaling", "--joints", "4,2", "--functions", "inverse_dynamics,mass_matrix", "--repetitions", "5"];
    let ended = run(&[&words[..], &["--chart", name, "--format", "json"]].concat());
    assert_eq!(ended.status, 0, "{}", ended.err);
    let report = ended.json();
    let points = report["points"].as_array().unwrap();
    let joints: Vec<u64> = points.iter().map(|p| p["joints"].as_u64().unwrap()).collect();
    assert_eq!(joints, [2, 4, 2, 4]);
    for point in points {
        for time in ["generated_hot", "generic_hot", "generated_cold", "generic_cold"] {
            assert!(point[time]["median"].as_f64().unwrap() > 0.0, "{point}");
        }
    }
    assert_eq!(report["crossovers"].as_array().unwrap().len(), 2);
    assert_eq!(report["growth"][1]["to"], 4);
    assert_eq!(report["units"]["points[].generated_cold"], "ns per call");
    let drawn = std::fs::read_to_string(chart).unwrap();
    // Each curve, and a piece of it in the legend.
    assert_eq!(drawn.matches("stroke-width=\"2\"").count(), 8 * 2);
    // Two points and one in the legend.
    assert_eq!(drawn.matches("<circle").count(), 8 * 3);
    assert!(drawn.starts_with("<svg ") && drawn.ends_with("</svg>\n"));
}

// No user can write there, not even an administrator.
#[cfg(target_os = "linux")]
#[test]
fn a_chart_that_cannot_be_written_does_not_cost_the_report() {
    let early = run(&["scaling", "--chart", "/no/such/folder/x.svg"]);
    assert!(early.status == 1 && early.out.is_empty() && early.err.contains("found no such folder"), "{}", early.err);
    let words = ["scaling", "--joints", "2", "--functions", "inverse_dynamics", "--repetitions", "5", "--chart", "/proc/x.svg"];
    let ended = run(&words);
    assert!(ended.status == 1 && ended.err.contains("error: /proc/x.svg: "), "{}", ended.err);
    assert!(ended.out.contains("inverse_dynamics"), "{}", ended.out);
    // As JSON the report is the one document.
    let ended = run(&[&words[..], &["--format", "json"]].concat());
    assert!(ended.status == 1 && ended.err.contains("error: /proc/x.svg: "), "{}", ended.err);
    assert_eq!(ended.json()["points"][0]["function"], "inverse_dynamics");
}

#[test]
fn lengths_are_joints() {
    for words in [["scaling", "--joints", "0"], ["scaling", "--joints", "7,x"], ["scaling", "--functions", "inverse"]] {
        assert_eq!(run(&words).status, 2, "{words:?}");
    }
}
