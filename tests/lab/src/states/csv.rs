//! A row for each state under the columns `q.<joint>`, `v.<joint>`, …, `wrenches.<link>[0]`, …;
//! `q.<joint>[0]`, `q.<joint>[1]`, … where a joint has several numbers.

use articulated_core::algorithm::Argument;
use csv::{ReaderBuilder, StringRecord, Trim};

use super::read::{Found, Gathering};
use super::{State, owner, slots};
use crate::table::counted;

/// Content of a column.
struct Column {
    argument: Argument,
    /// Index in it.
    at: usize,
    title: String,
}

pub(super) fn read(text: &str, found: &mut Found<'_>) {
    let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(text.as_bytes());
    let header = match reader.headers() {
        Ok(header) => header.clone(),
        Err(error) => return found.errors.push(format!("not CSV: {error}")),
    };
    let columns: Vec<Option<Column>> = header.iter().map(|title| column(title, found)).collect();
    repeated(&columns, found);
    if !found.errors.is_empty() {
        return;
    }
    for record in reader.records() {
        match record {
            Ok(record) => row(&record, line(&record, text), &columns, found),
            Err(error) => found.errors.push(format!("not CSV: {error}")),
        }
    }
}

fn column(title: &str, found: &mut Found<'_>) -> Option<Column> {
    let place = format!("column {title:?}");
    let Some((argument, rest)) = title.split_once('.') else {
        found.error(&place, "expected `q.<joint>`, `v.<joint>` or the like");
        return None;
    };
    let argument = found.argument(&place, argument)?;
    let slots = slots(argument, found.model);
    let (slot, number) = part(&place, argument, rest, found)?;
    let slot = &slots[slot];
    if number.is_none() && slot.count != 1 || number.is_some_and(|n| n >= slot.count) {
        let (what, name) = (owner(argument), format!("{}.{}", argument.name(), slot.name));
        found.error(&place, format!("this {what} has {} here, expected `{name}[0]` and so on", counted(slot.count, "number")));
        return None;
    }
    Some(Column { argument, at: slot.at + number.unwrap_or(0), title: title.to_owned() })
}

/// `name` or `name[k]`; a joint or link with the whole text as its name has precedence.
fn part(place: &str, argument: Argument, text: &str, found: &mut Found<'_>) -> Option<(usize, Option<usize>)> {
    if let Some(slot) = slots(argument, found.model).iter().position(|s| s.name == text) {
        return Some((slot, None));
    }
    let split = text.strip_suffix(']').and_then(|t| t.rsplit_once('['));
    let (name, number) = match split.and_then(|(name, k)| Some((name, k.parse::<usize>().ok()?))) {
        Some((name, k)) => (name, Some(k)),
        None => (text, None),
    };
    found.slot(place, argument, name).map(|slot| (slot, number))
}

fn repeated(columns: &[Option<Column>], found: &mut Found<'_>) {
    let known: Vec<&Column> = columns.iter().flatten().collect();
    for (k, column) in known.iter().enumerate() {
        let same = |c: &&&Column| (c.argument, c.at) == (column.argument, column.at);
        if known[..k].iter().any(|c| same(&c)) {
            found.error(&format!("column {:?}", column.title), "stands there twice");
        }
    }
}

/// Where a record begins, behind the empty lines that the reader counts to it.
fn line(record: &StringRecord, text: &str) -> usize {
    let Some(position) = record.position() else { return 0 };
    let from = text.as_bytes().get(position.byte() as usize..).unwrap_or_default();
    position.line() as usize + from.iter().take_while(|byte| b"\r\n".contains(byte)).filter(|byte| **byte == b'\n').count()
}

fn row(record: &StringRecord, line: usize, columns: &[Option<Column>], found: &mut Found<'_>) {
    let mut gatherings: Vec<Gathering> = Vec::new();
    let before = found.errors.len();
    for (column, text) in columns.iter().flatten().zip(record) {
        let Ok(x) = text.parse::<f64>() else {
            found.error(&format!("line {line}: {}", column.title), format!("found {text:?}, expected a number"));
            continue;
        };
        let at = gatherings.iter().position(|g| g.argument() == column.argument).unwrap_or_else(|| {
            gatherings.push(Gathering::new(column.argument, found));
            gatherings.len() - 1
        });
        gatherings[at].set(column.at, x);
    }
    let mut state = State::default();
    if found.errors.len() == before {
        for gathering in gatherings {
            let place = format!("line {line}: {}", gathering.argument().name());
            gathering.finish(&mut state, &place, found);
        }
    }
    found.push(state);
}

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::Argument;

    use crate::robot::bundled_model;
    use crate::states::read;

    #[test]
    fn columns_may_stand_in_any_order() {
        let model = bundled_model("cart_pole");
        let [a, b] = [&model.joints()[0].name, &model.joints()[1].name];
        let text = format!("v.{b}, q.{b},q.{a}, v.{a}\n4,2,1,3\n8, 6, 5, 7\n");
        let states = read(text.as_bytes(), &model).unwrap().states;
        assert_eq!(states.len(), 2);
        assert_eq!(states[1].get(Argument::Q), Some(&[5.0, 6.0][..]));
        assert_eq!(states[1].get(Argument::V), Some(&[7.0, 8.0][..]));
    }

    #[test]
    fn a_floating_base_has_numbered_columns() {
        let model = bundled_model("quadruped");
        let titles: Vec<String> = model
            .joints()
            .iter()
            .flat_map(|j| match j.q.1 {
                1 => vec![format!("q.{}", j.name)],
                n => (0..n).map(|k| format!("q.{}[{k}]", j.name)).collect(),
            })
            .collect();
        let mut numbers = vec!["0"; 19];
        numbers[6] = "1";
        let text = format!("{}\n{}\n", titles.join(","), numbers.join(","));
        assert_eq!(read(text.as_bytes(), &model).unwrap().states[0].get(Argument::Q).unwrap()[6], 1.0);
    }

    #[test]
    fn a_wrench_has_six_columns_and_other_links_carry_none() {
        let model = bundled_model("cart_pole");
        let at = model.frames().iter().position(|f| f.name == "pole_rod").unwrap();
        let titles: Vec<String> = (0..6).map(|k| format!("wrenches.pole_rod[{k}]")).collect();
        let states = read(format!("{}\n1,2,3,4,5,6\n", titles.join(",")).as_bytes(), &model).unwrap().states;
        let wrenches = states[0].get(Argument::Wrenches).unwrap();
        assert_eq!(wrenches[6 * at..][..6], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(wrenches.iter().sum::<f64>(), 21.0);
    }

    #[test]
    fn mistakes_are_named_with_line_and_column() {
        let model = bundled_model("cart_pole");
        let [a, b] = [&model.joints()[0].name, &model.joints()[1].name];
        let said = |text: String| read(text.as_bytes(), &model).unwrap_err().join("\n");
        assert!(said(format!("q.{a},q.{b}\n1,nan\n")).contains("line 2: q: joint"));
        assert!(said(format!("q.{a},q.{b}\n1,x\n")).contains("found \"x\""));
        assert!(said(format!("q.{a},q.{b}\n\n1,2\n\r\n\n1,x")).contains("line 6: q"));
        assert!(said(format!("q.{a}\n1\n")).contains("found nothing"));
        assert!(said(format!("q.{a},q.{a}\n1,1\n")).contains("twice"));
        assert!(said(format!("q.{a}x,q.{b}\n1,1\n")).contains("did you mean"));
        assert!(said(format!("q.{a},q.{b}\n1\n")).contains("not CSV"));
        assert!(said(format!("p.{a}\n1\n")).contains("expected one of q"));
        assert!(said(String::new()).contains("no state"));
    }

    #[test]
    fn a_ball_has_four_numbers_of_q_and_three_of_v() {
        let urdf = "<robot name='r'><link name='base'/><link name='bob'/>
            <joint name='ball' type='spherical'><parent link='base'/><child link='bob'/></joint></robot>";
        let model = articulated::load_bytes("r.urdf", urdf.as_bytes(), articulated_core::description::Base::Fixed).unwrap();
        let told = |titles: &str| {
            let row = vec!["0.5"; titles.split(',').count()].join(",");
            read(format!("{titles}\n{row}\n").as_bytes(), &model).map(|found| found.states).map_err(|told| told.join("\n"))
        };
        let all = "q.ball[0],q.ball[1],q.ball[2],q.ball[3],v.ball[0],v.ball[1],v.ball[2]";
        assert_eq!(told(all).unwrap()[0].get(Argument::Q), Some(&[0.5; 4][..]));
        for (title, count, name) in [("q.ball[4]", 4, "q.ball"), ("q.ball", 4, "q.ball"), ("v.ball[3]", 3, "v.ball")] {
            let expected = format!("column \"{title}\": this joint has {count} numbers here, expected `{name}[0]` and so on");
            let found = told(&format!("{all},{title}")).unwrap_err();
            assert!(found.contains(&expected), "{found}");
        }
    }
}
