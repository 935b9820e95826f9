//! Names that are cut to the available room.

use std::collections::BTreeMap;

use articulated_lab::plot::width;

/// A text no wider than `most`, with … in its middle if it is too long: most names differ at their
/// ends.
fn fitted(text: &str, size: f64, most: f64) -> String {
    if width(text, size) <= most {
        return text.to_owned();
    }
    let letters: Vec<char> = text.chars().collect();
    let cut = |keep: usize| {
        let (head, tail) = (keep.div_ceil(2), keep / 2);
        let part = |from: usize, to: usize| letters[from..to].iter().collect::<String>();
        part(0, head) + "…" + &part(letters.len() - tail, letters.len())
    };
    (0..letters.len()).rev().map(cut).find(|t| width(t, size) <= most).unwrap_or_default()
}

/// Each label is no wider than `most`; in names that would look alike, the common part is cut
/// first.
pub(super) fn told_apart(names: &[String], size: f64, most: f64) -> Vec<String> {
    let mut labels: Vec<String> = names.iter().map(|name| fitted(name, size, most)).collect();
    let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    labels.iter().enumerate().for_each(|(k, label)| groups.entry(label.clone()).or_default().push(k));
    for group in groups.values() {
        let alike: Vec<Vec<char>> = group.iter().map(|&k| names[k].chars().collect()).collect();
        let (head, tail) = shared(&alike);
        if head + tail == 0 || alike.iter().all(|name| *name == alike[0]) {
            continue;
        }
        let middles: Vec<String> = alike.iter().map(|name| name[head..name.len() - tail].iter().collect()).collect();
        let middles = told_apart(&middles, size, most - width("……", size));
        for ((&k, name), middle) in group.iter().zip(&alike).zip(&middles) {
            labels[k] = around(&name[..head], middle, &name[name.len() - tail..], size, most);
        }
    }
    labels
}

/// Number of letters that all names begin and end with, without splitting numbers.
fn shared(names: &[Vec<char>]) -> (usize, usize) {
    let Some(first) = names.first() else { return (0, 0) };
    let shortest = names.iter().map(Vec::len).min().unwrap_or(0);
    let same = |at: &dyn Fn(&[char]) -> char| names.iter().all(|name| at(name) == at(first));
    let mut head = (0..shortest).take_while(|&k| same(&|name| name[k])).count();
    let mut tail = (0..shortest - head).take_while(|&k| same(&|name| name[name.len() - 1 - k])).count();
    while head > 0 && first[head - 1].is_numeric() {
        head -= 1;
    }
    while tail > 0 && first[first.len() - tail].is_numeric() {
        tail -= 1;
    }
    (head, tail)
}

/// As much of the head and of the tail around the middle as fits.
fn around(head: &[char], middle: &str, tail: &[char], size: f64, most: f64) -> String {
    let cut = |keep: usize| {
        let (begin, end) = (keep.min(head.len()), tail.len() - keep.min(tail.len()));
        let gap = |cut: bool| if cut { "…" } else { "" };
        let [head_kept, tail_kept] = [&head[..begin], &tail[end..]].map(|part| part.iter().collect::<String>());
        let text = format!("{head_kept}{}{middle}{}{tail_kept}", gap(begin < head.len()), gap(end > 0));
        text.replace("……", "…")
    };
    let most_kept = head.len().max(tail.len());
    (0..=most_kept).rev().map(cut).find(|text| width(text, size) <= most).unwrap_or_else(|| middle.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(names: &[&str], most: f64) -> Vec<String> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let labels = told_apart(&names, 10.0, most);
        assert!(labels.iter().all(|label| width(label, 10.0) <= most), "{labels:?}");
        labels
    }

    #[test]
    fn a_text_that_is_cut_keeps_its_ends() {
        assert_eq!(labels(&["hip"], 100.0), ["hip"]);
        let cut = &labels(&["left_front_hip_abduction_joint"], 80.0)[0];
        assert!(cut.starts_with("left") && cut.ends_with("joint") && cut.contains('…'), "{cut}");
        assert_eq!(labels(&["name", "same"], 0.0), ["", ""]);
    }

    #[test]
    fn names_that_differ_in_the_middle_keep_it() {
        let name = |k: usize| format!("joint_with_a_very_long_name_{k}_that_ends_in_ümläut<&>");
        let names: Vec<String> = (0..40).map(name).collect();
        let labels = labels(&names.iter().map(String::as_str).collect::<Vec<_>>(), 126.0);
        for (k, label) in labels.iter().enumerate() {
            assert!(label.starts_with("join") && label.contains(&format!("…{k}…")) && label.ends_with("<&>"), "{label}");
        }
    }

    #[test]
    fn names_that_differ_in_several_places_stay_apart() {
        let legs = ["left_front", "left_rear"]
            .map(|leg| ["abduction", "flexion"].map(|axis| format!("quadruped_robot_{leg}_hip_{axis}_joint_of_motor")));
        let names: Vec<&str> = legs.iter().flatten().map(String::as_str).chain(["short", "short"]).collect();
        let labels = labels(&names, 100.0);
        assert_eq!(labels[4..], ["short", "short"]);
        assert!((0..4).all(|k| !labels[k + 1..].contains(&labels[k])), "{labels:?}");
    }

    #[test]
    fn numbers_are_not_torn() {
        let labels = labels(&["a_very_long_beginning_of_10_and_its_end", "a_very_long_beginning_of_20_and_its_end"], 90.0);
        assert!(labels[0].contains("…10…") && labels[1].contains("…20…"), "{labels:?}");
    }
}
