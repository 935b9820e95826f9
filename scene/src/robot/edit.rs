//! The robot that is asked for: read, other robots appended, payloads attached, shafts made to bend, joints locked, frames chosen; in this order, so that a payload may
//! hang on an appended robot, and a lock may hold its joints.

use std::collections::HashSet;

use articulated_core::description::{Base, Description, EditError, Editor};
use articulated_core::effect::Applied;
use articulated_core::model::Model;
use articulated_core::suggest::Suggester;
use articulated_urdf::{Reading, SNAP_EXPECTED, Subject, Unused, can_snap};

use super::error::{Edit, Reason, Refusal, RobotError};
use super::options::{Appended, RobotAsked, RobotOptions};

impl RobotAsked<'_> {
    /// Reads the robot and edits it. Everything that is wrong with the document, or else everything that is wrong with the edits.
    pub fn read(&self) -> Result<Reading, RobotError> {
        self.read_with_shafts().map(|(reading, _)| reading)
    }

    /// As [`read`](Self::read), with the springs and dampings of each shaft.
    pub fn read_with_shafts(&self) -> Result<(Reading, Vec<Vec<Applied>>), RobotError> {
        let options = self.options;
        numbers(options)?;
        let reading = articulated_urdf::read(self.urdf, &self.reader_options())?;
        let mut editing = Editing { asked: *self, reading, refusals: Vec::new() };
        let (springs, appended) = editing.edit();
        editing.check_frames();
        if !appended {
            editing.forget_the_unknown();
        }
        editing.warn();
        editing.reading.warnings.extend(options.warnings.iter().cloned());
        if editing.refusals.is_empty() { Ok((editing.reading, springs)) } else { Err(RobotError::Edits { refusals: editing.refusals }) }
    }

    /// The model of what was [read](Self::read), under the gravity, with the effects and with the reference of wrenches that are asked for, and with a frame for every link.
    pub fn model(&self, description: &Description) -> Result<Model<f64>, RobotError> {
        let options = self.options;
        let model = Model::new(description, options.base).map_err(|error| RobotError::Model { file: self.file.to_owned(), error })?;
        let model = model.with_gravity(options.gravity).with_wrenches_in(options.wrench_reference);
        model.with_effects(&options.effects).map_err(|errors| RobotError::Effects { file: self.file.to_owned(), errors: errors.0 })
    }

    /// The model with the frames that are asked for.
    pub fn choose_frames(&self, model: Model<f64>) -> Result<Model<f64>, RobotError> {
        let Some(names) = &self.options.frames else { return Ok(model) };
        model.with_frames(names).map_err(|error| {
            let is = |n: &String| matches!(&error, EditError::UnknownLink { name, .. } if n == name);
            let at = names.iter().position(is).unwrap_or_default();
            let reason = Reason::Edit(error);
            RobotError::Edits { refusals: vec![Refusal { file: self.file.to_owned(), edit: Edit::Frame(at), reason }] }
        })
    }

    fn reader_options(&self) -> articulated_urdf::Options {
        articulated_urdf::Options {
            file: self.file.to_owned(),
            base: self.options.base,
            allow_unphysical_inertia: self.options.allow_unphysical_inertia,
            snap_angles: self.options.snap_angles,
        }
    }
}

/// Whether the numbers among the choices can be. Errors: all that cannot.
fn numbers(options: &RobotOptions) -> Result<(), RobotError> {
    let wrong = |key, found, expected| RobotError::Number { key, found, expected };
    let gravity = options.gravity.iter().any(|x| !x.is_finite());
    let gravity = gravity.then(|| wrong("gravity", format!("{:?}", options.gravity), "three finite numbers in m/s²"));
    let snapped = options.snap_angles.filter(|x| !can_snap(*x));
    let snapped = snapped.map(|x| wrong("snap_angles", x.to_string(), SNAP_EXPECTED));
    RobotError::of(gravity.into_iter().chain(snapped).collect()).map_or(Ok(()), Err)
}

/// A robot while it is edited.
pub(super) struct Editing<'a> {
    pub(super) asked: RobotAsked<'a>,
    pub(super) reading: Reading,
    refusals: Vec<Refusal>,
}

impl Editing<'_> {
    /// Makes all edits. Gives the springs and dampings of each shaft, and whether all that was to be appended is there.
    fn edit(&mut self) -> (Vec<Vec<Applied>>, bool) {
        let mut description = std::mem::take(&mut self.reading.description);
        let mut editor = Editor::of(&mut description);
        let (options, mut springs) = (self.asked.options, Vec::new());
        options.append.iter().enumerate().for_each(|(i, other)| self.append(i, other, &mut editor));
        let appended = self.refusals.is_empty();
        for (i, payload) in options.payloads.iter().enumerate() {
            self.take(Edit::Payload(i), editor.attach(payload).map(drop).map_err(Reason::Edit));
        }
        for (i, shaft) in options.shafts.iter().enumerate() {
            let result = editor.shaft(shaft).map(|own| springs.push(own));
            self.take(Edit::Shaft(i), result.map_err(Reason::Edit));
        }
        for (i, (joint, at)) in options.lock.iter().enumerate() {
            self.take(Edit::Lock(i), editor.lock(joint, at).map_err(Reason::Edit));
        }
        self.reading.description = description;
        (springs, appended)
    }

    fn take(&mut self, edit: Edit, result: Result<(), Reason>) {
        if let Err(reason) = result {
            self.refusals.push(Refusal { file: self.asked.file.to_owned(), edit, reason });
        }
    }

    fn append(&mut self, index: usize, other: &Appended, editor: &mut Editor<'_>) {
        // Its root moves with the link that carries it.
        let options = articulated_urdf::Options { file: other.file.clone(), base: Base::Floating, ..self.asked.reader_options() };
        let result = match articulated_urdf::read(&other.urdf, &options) {
            Err(problems) => Err(Reason::Urdf(problems)),
            Ok(reading) => {
                let result = editor.append(&other.at, &reading.description, &other.prefix, other.origin);
                self.reading.warnings.extend(reading.warnings);
                self.reading.snapped.extend(reading.snapped);
                self.reading.unused.extend(reading.unused.into_iter().map(|u| renamed(u, &other.prefix)));
                result.map_err(Reason::Edit)
            }
        };
        self.take(Edit::Append(index), result);
    }

    fn check_frames(&mut self) {
        let Some(frames) = &self.asked.options.frames else { return };
        let links = &self.reading.description.links;
        let names: HashSet<&str> = links.iter().map(|l| l.name.as_str()).collect();
        let (mut seen, mut suggester) = (HashSet::new(), Suggester::default());
        let mut refused = Vec::new();
        for (i, name) in frames.iter().enumerate() {
            if !names.contains(name.as_str()) {
                let nearest = suggester.nearest(name, links.iter().map(|l| l.name.as_str())).map(str::to_owned);
                refused.push((i, Reason::Edit(EditError::UnknownLink { name: name.clone(), nearest })));
            } else if !seen.insert(name) {
                refused.push((i, Reason::FrameTwice(name.clone())));
            }
        }
        refused.into_iter().for_each(|(i, reason)| self.take(Edit::Frame(i), Err(reason)));
    }

    /// What an appended robot would have had is not unknown.
    fn forget_the_unknown(&mut self) {
        let unknown = |r: &Refusal| matches!(r.reason, Reason::Edit(EditError::UnknownLink { .. } | EditError::UnknownJoint { .. }));
        self.refusals.retain(|r| matches!(r.edit, Edit::Append(_)) || !unknown(r));
    }
}

/// What is not used of an appended robot, under its new names.
fn renamed(unused: Unused, prefix: &str) -> Unused {
    let subject = match unused.subject {
        Subject::Document => Subject::Document,
        Subject::Link(name) => Subject::Link(format!("{prefix}{name}")),
        Subject::Joint(name) => Subject::Joint(format!("{prefix}{name}")),
    };
    Unused { subject, ..unused }
}

#[cfg(test)]
mod tests {
    use articulated_core::description::{Origin, Payload, Shaft};
    use articulated_core::effect::EffectId;
    use articulated_urdf::{Kind, MOST_SNAPPED, Problem};

    use super::*;

    /// As no body is, which is a warning.
    const LINK: &str = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='3'/></inertial>";

    /// A link that turns on another, between these bounds, with a colour that nobody uses; its axis is nearly that of z.
    fn robot(name: &str) -> String {
        format!(
            "<robot name='{name}'><link name='base'>{LINK}</link><link name='tip'>{LINK}<visual/></link>
            <joint name='hinge' type='revolute'><parent link='base'/><child link='tip'/><origin rpy='1.5707963 0 0'/><axis xyz='0 0 2'/>
            <limit lower='-1' upper='2' effort='1' velocity='1'/><calibration rising='0'/></joint></robot>"
        )
    }

    fn asked() -> Own {
        let mut asked = Own { file: "arm.urdf", urdf: robot("arm"), options: RobotOptions::default() };
        asked.options.snap_angles = Some(1e-6);
        asked
    }

    /// What is asked, with its document.
    struct Own {
        file: &'static str,
        urdf: String,
        options: RobotOptions,
    }

    fn read(own: &Own) -> Result<Reading, RobotError> {
        RobotAsked { file: own.file, urdf: own.urdf.as_bytes(), options: &own.options }.read()
    }

    fn appended(at: &str) -> Appended {
        Appended {
            urdf: robot("hand").into_bytes(),
            file: "hand.urdf".into(),
            at: at.into(),
            prefix: "left_".into(),
            origin: Origin::default(),
        }
    }

    #[test]
    fn a_tolerance_of_angles_is_above_nothing() {
        for (tolerance, found) in [(0.0, "0"), (MOST_SNAPPED * 2.0, "1"), (f64::NAN, "NaN")] {
            let mut asked = asked();
            asked.options.snap_angles = Some(tolerance);
            let expected = "expected a finite number above 0, at most 0.5 rad; leave it out to snap none";
            assert_eq!(read(&asked).unwrap_err().to_string(), format!("snap_angles: found {found}, {expected}"));
        }
    }

    fn refused(asked: &Own) -> Vec<Edit> {
        match read(asked) {
            Err(RobotError::Edits { refusals }) => refusals.into_iter().map(|r| r.edit).collect(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_is_said_of_an_appended_robot_is_said_of_the_whole() {
        let alone = read(&asked()).unwrap();
        let mut asked = asked();
        asked.options.append.push(appended("tip"));
        let both = read(&asked).unwrap();
        let hand = |problems: &[Problem]| problems.iter().filter(|p| p.file == "hand.urdf").count();
        assert_eq!((hand(&both.snapped), both.snapped.len()), (alone.snapped.len(), 2 * alone.snapped.len()));
        assert_eq!(both.warnings.len() - hand(&both.warnings), alone.warnings.len());
        assert!(hand(&both.warnings) == alone.warnings.len() && !alone.warnings.is_empty(), "{:?}", both.warnings);
        // The mass of its root moves; that of a fixed base does nothing.
        let held = |reading: &Reading| reading.unused.iter().filter(|u| u.tag == "inertial").count();
        assert_eq!((held(&both), held(&alone)), (1, 1));
        let subjects: Vec<&Subject> = both.unused.iter().map(|u| &u.subject).collect();
        for subject in [Subject::Link("tip".into()), Subject::Link("left_tip".into()), Subject::Joint("left_hinge".into())] {
            assert!(subjects.contains(&&subject), "{subjects:?}");
        }
    }

    #[test]
    fn a_lock_is_told_of_where_it_is_beyond_a_bound() {
        for (at, beyond) in [(-1.5, true), (-1.0, false), (0.0, false), (2.0, false), (2.5, true)] {
            let mut asked = asked();
            asked.options.lock.push(("hinge".into(), vec![at]));
            let warnings = read(&asked).unwrap().warnings;
            assert_eq!(warnings.iter().any(|w| w.kind == Kind::BeyondLimit), beyond, "{at}");
        }
    }

    #[test]
    fn a_load_is_told_of_where_the_base_holds_it() {
        let warned = |change: &dyn Fn(&mut RobotOptions)| {
            let mut asked = asked();
            change(&mut asked.options);
            read(&asked).unwrap().warnings.iter().filter(|w| w.field == "payload").count()
        };
        let load = |link: &str, mass: f64| Payload { link: link.into(), mass, ..Payload::default() };
        assert_eq!(warned(&|o| o.payloads.extend([load("base", 1.0), load("tip", 1.0), load("base", 0.0)])), 1);
        let locked = |o: &mut RobotOptions| {
            o.payloads.push(load("tip", 1.0));
            o.lock.push(("hinge".into(), vec![0.0]));
        };
        assert_eq!(warned(&locked), 1);
        assert_eq!(warned(&|o| (o.base, o.payloads) = (Base::Floating, vec![load("base", 1.0)])), 0);
    }

    #[test]
    fn a_load_that_misses_the_triangle_inequality_is_told_of_and_used_as_a_links_inertia_is() {
        let told = |inertia: [f64; 6]| {
            let mut asked = asked();
            asked.options.payloads.push(Payload { link: "tip".into(), mass: 1.0, inertia, ..Payload::default() });
            let warnings = read(&asked).unwrap().warnings.into_iter().filter(|w| w.field == "payload");
            warnings.map(|w| (w.kind, w.found, w.expected)).collect::<Vec<_>>()
        };
        let expected = "none greater than the other two together (triangle inequality); used as asked for";
        let of = |found: &str| vec![(Kind::InertiaTriangle, format!("the principal moments {found} kg·m²"), expected.to_owned())];
        assert_eq!(told([1.0, 0.0, 0.0, 1.0, 0.0, 3.0]), of("1.000e0, 1.000e0, 3.000e0"));
        // The moments 0, 1 − 0.0009 and 1 + 0.0009.
        assert_eq!(told([0.0, 0.0, 0.0, 1.0, 0.0009, 1.0]), of("0, 9.991e-1, 1.001e0"));
        assert_eq!(told([0.0, 0.0, 0.0, 1.0, 1e-7, 1.0]), []);
    }

    /// A hand and, fixed to it, a tip and a lamp.
    fn club() -> Own {
        let fixed = |link: &str| {
            format!(
                "<link name='{link}'>{LINK}</link><joint name='to_{link}' type='fixed'><parent link='hand'/><child link='{link}'/>
                <origin xyz='1 0 0'/></joint>"
            )
        };
        let urdf = format!("<robot name='club'><link name='hand'>{LINK}</link>{}{}</robot>", fixed("tip"), fixed("lamp"));
        Own { file: "club.urdf", urdf, options: RobotOptions::default() }
    }

    #[test]
    fn mass_that_a_shaft_carries_or_takes_is_not_held_by_the_base() {
        let held = |shaft: Option<Shaft>| {
            let mut asked = club();
            asked.options.shafts.extend(shaft);
            let unused = read(&asked).unwrap().unused.into_iter().filter(|u| u.tag == "inertial");
            unused.map(|u| u.subject.to_string()).collect::<Vec<_>>()
        };
        let shaft = |mass| Some(Shaft { joint: "to_tip".into(), segments: 2, stiffness: 1.0, mass, ..Shaft::default() });
        assert_eq!(held(None), ["link \"hand\"", "link \"tip\"", "link \"lamp\""]);
        assert_eq!(held(shaft(Some(0.1))), ["link \"hand\"", "link \"lamp\""]);
        assert_eq!(held(shaft(None)), ["link \"lamp\""]);
    }

    #[test]
    fn what_thousands_of_edits_and_effects_use_is_soon_found() {
        let count = 5000;
        let link = |k| format!("<link name='l{k}'>{LINK}</link>");
        let joint = |k| {
            format!(
                "<joint name='j{k}' type='continuous'><parent link='tip'/><child link='l{k}'/><axis xyz='0 0 1'/>
                <dynamics damping='0.5' friction='0.25'/></joint>"
            )
        };
        let all: String = (0..count).map(link).chain((0..count).map(joint)).collect();
        let mut asked = asked();
        asked.urdf = robot("arm").replace("</robot>", &(all + "</robot>"));
        let damping = |k| Applied { effect: EffectId::damping, on: format!("j{k}"), at: Origin::default(), parameters: vec![0.5] };
        asked.options.effects = (1..count).map(damping).collect();
        asked.options.lock = (0..count).map(|k| (format!("j{k}"), vec![0.0])).collect();
        asked.options.payloads = vec![Payload { link: "l0".into(), mass: 1.0, ..Payload::default() }; count];
        let reading = read(&asked).unwrap();
        let left = |tag: &str| reading.unused.iter().filter(|u| u.tag == tag).map(|u| u.subject.to_string()).collect::<Vec<_>>();
        assert_eq!((left("dynamics damping"), left("dynamics friction").len()), (vec!["joint \"j0\"".to_owned()], count));
        assert_eq!(reading.warnings.iter().filter(|w| w.field == "payload").count(), 0);
    }

    #[test]
    fn each_frame_is_listed_once_and_is_a_link() {
        let mut asked = asked();
        asked.options.frames = Some(["tip", "base", "tap", "tip"].map(String::from).to_vec());
        assert_eq!(refused(&asked), [Edit::Frame(2), Edit::Frame(3)]);
    }

    #[test]
    fn very_many_frames_that_there_are_not_are_told_soon_and_the_first_with_what_was_meant() {
        let mut asked = asked();
        let links: String = (0..5000).map(|k| format!("<link name='link_{k:05}'/>")).collect();
        let joint = |k| format!("<joint name='j{k}' type='fixed'><parent link='tip'/><child link='link_{k:05}'/></joint>");
        let robot = robot("arm").replace("</robot>", &(links + &(0..5000).map(joint).collect::<String>() + "</robot>"));
        asked.urdf = robot;
        asked.options.frames = Some((0..5000).map(|k| format!("lynk_{k:05}")).collect());
        let Err(RobotError::Edits { refusals }) = read(&asked) else { panic!("frames that there are not") };
        let meant = |r: &Refusal| matches!(&r.reason, Reason::Edit(EditError::UnknownLink { nearest: Some(_), .. }));
        assert_eq!((refusals.len(), meant(&refusals[0]), meant(&refusals[4999])), (5000, true, false));
    }

    #[test]
    fn where_a_robot_cannot_be_appended_its_names_are_not_unknown() {
        let mut asked = asked();
        asked.options.append.push(appended("top"));
        asked.options.payloads.push(Payload { link: "left_tip".into(), mass: 1.0, ..Payload::default() });
        asked.options.payloads.push(Payload { link: "tip".into(), mass: -1.0, ..Payload::default() });
        asked.options.lock.push(("left_hinge".into(), vec![0.0]));
        asked.options.frames = Some(vec!["left_tip".into()]);
        assert_eq!(refused(&asked), [Edit::Append(0), Edit::Payload(1)]);
        asked.options.append[0].at = "tip".into();
        assert_eq!(refused(&asked), [Edit::Payload(1)]);
        asked.options.append.clear();
        assert_eq!(refused(&asked), [Edit::Payload(0), Edit::Payload(1), Edit::Lock(0), Edit::Frame(0)]);
    }
}
