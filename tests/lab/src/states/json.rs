//! `{"states": [{"q": [...], "v": {"joint": 0.1, ...}, "wrenches": {"link": [...]}}, ...]}`, or the
//! list alone.

use articulated_core::algorithm::Argument;
use serde_json::Value;

use super::read::{Found, Gathering};
use super::unique::{self, Json};
use super::{State, owner, slots};
use crate::table::counted;

pub(super) fn read(text: &str, found: &mut Found<'_>) {
    let value = match unique::parse(text) {
        Ok(value) => value,
        Err(error) if error.is_data() => return found.errors.push(error.to_string()),
        Err(error) => return found.errors.push(format!("not JSON: {error}")),
    };
    let list = match &value {
        Json::List(list) => Some(list.as_slice()),
        Json::Object(object) => {
            alone("states", object, found);
            object.iter().find(|(key, _)| key == "states").and_then(|(_, value)| value.list())
        }
        Json::Single(_) => None,
    };
    let Some(list) = list else {
        if !found.errors.is_empty() {
            return;
        }
        return found.errors.push("found an object without a list, expected {\"states\": [...]} or a list of states".into());
    };
    for (k, entry) in list.iter().enumerate() {
        let place = format!("states[{k}]");
        match entry {
            Json::Object(object) => state(&place, object, found),
            other => found.error(&place, format!("found {}, expected an object", kind(other))),
        }
    }
}

/// An error for each key other than the known one.
fn alone(known: &str, object: &[(String, Json)], found: &mut Found<'_>) {
    for (key, _) in object.iter().filter(|(key, _)| key != known) {
        found.errors.push(format!("found the key {key:?}, expected {known:?} alone"));
    }
}

fn state(place: &str, object: &[(String, Json)], found: &mut Found<'_>) {
    let mut state = State::default();
    for (key, value) in object {
        let Some(argument) = found.argument(place, key) else { continue };
        let place = format!("{place}: {key}");
        match value {
            Json::List(list) => {
                if let Some(numbers) = rows(&place, argument, list, found) {
                    found.take(&mut state, argument, &place, numbers);
                }
            }
            Json::Object(parts) => by_name(&place, argument, parts, &mut state, found),
            other => found.error(&place, format!("found {}, expected a list or an object", kind(other))),
        }
    }
    found.push(state);
}

/// The numbers of a list, or of a list of lists for an argument of two dimensions.
fn rows(place: &str, argument: Argument, list: &[Json], found: &mut Found<'_>) -> Option<Vec<f64>> {
    if argument.dims().len() < 2 || !list.iter().any(|row| row.list().is_some()) {
        return numbers(place, list, found);
    }
    let width = argument.dims()[1].len(found.model.shape());
    let mut all = Vec::new();
    for (k, row) in list.iter().enumerate() {
        let row = row.list().filter(|r| r.len() == width);
        let Some(row) = row else {
            found.error(&format!("{place}[{k}]"), format!("expected a list of {}", counted(width, "number")));
            return None;
        };
        all.extend(numbers(&format!("{place}[{k}]"), row, found)?);
    }
    Some(all)
}

fn by_name(place: &str, argument: Argument, parts: &[(String, Json)], state: &mut State, found: &mut Found<'_>) {
    let before = found.errors.len();
    let slots = slots(argument, found.model);
    let mut gathering = Gathering::new(argument, found);
    for (name, value) in parts {
        let Some(slot) = found.slot(place, argument, name).map(|k| &slots[k]) else { continue };
        let place = format!("{place}: {} {name:?}", owner(argument));
        let given = match value {
            Json::List(list) => numbers(&place, list, found),
            single => numbers(&place, std::slice::from_ref(single), found),
        };
        let Some(given) = given else { continue };
        if given.len() != slot.count {
            found.error(&place, format!("found {}, expected {}", counted(given.len(), "number"), slot.count));
            continue;
        }
        given.into_iter().enumerate().for_each(|(k, x)| gathering.set(slot.at + k, x));
    }
    // One error is one message: missing values are reported only without other errors.
    if found.errors.len() == before {
        gathering.finish(state, place, found);
    }
}

fn numbers(place: &str, list: &[Json], found: &mut Found<'_>) -> Option<Vec<f64>> {
    let wrong: Vec<String> = list.iter().filter(|x| x.number().is_none()).map(kind).collect();
    if let Some(first) = wrong.first() {
        found.error(place, format!("found {first}, expected a number"));
        return None;
    }
    Some(list.iter().filter_map(Json::number).collect())
}

fn kind(value: &Json) -> String {
    match value {
        Json::Single(Value::String(s)) => format!("{:?}", s.chars().take(40).collect::<String>()),
        Json::Single(other) => other.to_string(),
        Json::List(_) => "a list".into(),
        Json::Object(_) => "an object".into(),
    }
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::Argument;

    use crate::robot::bundled_model;
    use crate::states::read;

    fn errors(robot: &str, text: &str) -> String {
        read(text.as_bytes(), &bundled_model(robot)).unwrap_err().join("\n")
    }

    #[test]
    fn lists_and_names_say_the_same() {
        let model = bundled_model("cart_pole");
        let [a, b] = [&model.joints()[0].name, &model.joints()[1].name];
        let list = read(br#"[{"q": [1, 2], "v": [3, 4]}]"#, &model).unwrap().states;
        let text = format!(r#"{{"states": [{{"q": {{"{b}": 2, "{a}": [1]}}, "v": {{"{a}": 3, "{b}": 4}}}}]}}"#);
        assert_eq!(list, read(text.as_bytes(), &model).unwrap().states);
        assert_eq!(list[0].get(Argument::Q), Some(&[1.0, 2.0][..]));
        assert_eq!(list[0].get(Argument::A), None);
    }

    #[test]
    fn wrenches_are_by_link_or_row_by_row() {
        let model = bundled_model("cart_pole").with_frames(&["cart", "pole_rod"]).unwrap();
        let [a, b] = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.0; 6]];
        let flat = serde_json::json!([{"wrenches": ([a, b].concat())}, {"wrenches": [a, b]}, {"wrenches": {"cart": a}}]);
        let states = read(flat.to_string().as_bytes(), &model).unwrap().states;
        assert!(states.iter().all(|s| s.get(Argument::Wrenches) == Some(&[a, b].concat()[..])), "{states:?}");
        let said = |wrenches: serde_json::Value| {
            read(serde_json::json!([{"wrenches": wrenches}]).to_string().as_bytes(), &model).unwrap_err().join("\n")
        };
        assert!(said(serde_json::json!({"cartt": a})).contains("did you mean \"cart\"?"));
        assert!(said(serde_json::json!({"cart": [1, 2]})).contains("link \"cart\": found 2 numbers, expected 6"));
        assert!(said(serde_json::json!([a, [1]])).contains("wrenches[1]: expected a list of 6"));
        assert!(said(serde_json::json!([1, 2])).contains("found 2 numbers, expected 12"));
    }

    #[test]
    fn a_key_stands_once_and_is_known() {
        let twice = [
            (r#"[{"q": [1, 2], "q": [3, 4]}]"#, "q"),
            (r#"[{"q": {"slide": 1, "pole": 2, "slide": 3}}]"#, "slide"),
            (r#"{"states": [], "states": [{"q": [1, 2]}]}"#, "states"),
        ];
        for (text, key) in twice {
            let said = errors("cart_pole", text);
            assert!(said.starts_with(&format!("found the key {key:?} twice, expected it once at line 1")), "{said}");
        }
        let unknown = errors("cart_pole", r#"{"robot": "x", "states": [{"q": [1, 2]}]}"#);
        assert_eq!(unknown, "found the key \"robot\", expected \"states\" alone");
        assert_eq!(errors("cart_pole", r#"{"state": []}"#), "found the key \"state\", expected \"states\" alone");
    }

    #[test]
    fn uniform_numbers_are_less_than_one() {
        let said = errors("cart_pole", r#"[{"uniform": [1, -0.5]}]"#);
        assert!(said.contains("found 1, expected 0 or more") && said.contains("found -0.5"), "{said}");
    }

    #[test]
    fn every_mistake_is_named_with_its_state() {
        let text = r#"[{"q": [1]}, {"q": [1, null]}, {"w": [1, 2]}, 3, {"q": {"cart_jiont": 1}}]"#;
        let said = errors("cart_pole", text);
        for part in ["states[0]: q: found 1 number, expected 2", "states[1]: q: found null", "states[2]: found \"w\"", "states[3]: found 3"]
        {
            assert!(said.contains(part), "{said}");
        }
        assert!(said.contains("states[4]: q: found joint \"cart_jiont\""), "{said}");
        for broken in ["{", "[]", "{\"states\": 1}", "[{\"q\": [1e999, 0]}]"] {
            assert!(!errors("cart_pole", broken).is_empty());
        }
    }

    #[test]
    fn coordinates_beyond_any_sense_are_one_warning() {
        let model = bundled_model("cart_pole");
        let warnings = |text: &str| read(text.as_bytes(), &model).unwrap().warnings;
        let told = warnings(r#"[{"q": [0, 1e15]}, {"q": [1e6, -1e6]}, {"q": [-2e6, 0], "v": [1e9, 0]}]"#);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(
            told[0].starts_with("states[0]: q: joint")
                && told[0].contains("found the coordinate 1000000000000000.0")
                && told[0].ends_with("(and 1 more states)"),
            "{told:?}"
        );
        assert!(warnings(r#"[{"q": [0, 1e6], "v": [1e9, 0]}]"#).is_empty());
    }

    #[test]
    fn a_quaternion_is_a_unit() {
        let state = |w: f64| {
            let mut q = vec![0.0; 19];
            q[6] = w;
            serde_json::json!([{"q": q}]).to_string()
        };
        let model = bundled_model("quadruped");
        assert!(errors("quadruped", &state(1.1)).contains("norm 1.1"));
        let mended = read(state(1.0 + 1e-8).as_bytes(), &model).unwrap();
        assert_eq!(mended.warnings.len(), 1);
        assert_eq!(mended.states[0].get(Argument::Q).unwrap()[6], 1.0);
        assert!(read(state(1.0).as_bytes(), &model).unwrap().warnings.is_empty());
    }
}
