//! A robot in one configuration as a page. A program that serves the page feeds it with placements.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use articulated_codegen::Request;
use articulated_core::description::Base;
use articulated_core::diagnostic::summary as lines;

use super::in_process::{WithWarnings, warned};
use super::page::{self, Meshes, Setting};
use super::recording::Recording;
use crate::arguments::Package;
use crate::console;
use crate::failure::Failure;

/// The page of a robot at `q`. `packages`: folders of ROS packages, `NAME=FOLDER` or `FOLDER`, for
/// meshes; those of the request follow them.
///
/// A warning reports each mesh that is not drawn as it is.
pub fn page<P: AsRef<OsStr>>(request: &Request, q: &[f64], title: &str, packages: &[P]) -> WithWarnings<String> {
    warned(|| {
        let built = request.build_robot()?;
        let options = &request.options.robot;
        if q.len() != built.model.nq() {
            return Err(Failure::input([format!("q: found {} numbers, expected {}", q.len(), built.model.nq())]));
        }
        let parsed: Result<Vec<Package>, String> = packages.iter().map(|text| Package::parse(&text.as_ref().to_string_lossy())).collect();
        let own = options.packages.iter().map(|(name, folder)| Package { name: name.clone(), folder: folder.clone() });
        let packages: Vec<Package> =
            parsed.map_err(|error| Failure::input([format!("packages: {error}")]))?.into_iter().chain(own).collect();
        let files = [request.file.as_str()].into_iter().chain(options.append.iter().map(|other| other.file.as_str()));
        let folders: Vec<PathBuf> = files.filter_map(|file| Path::new(file).parent()).map(Path::to_owned).collect();
        let meshes = Meshes::new(folders, &packages, &request.file);
        let setting = Setting {
            title,
            note: if options.base == Base::Fixed { "fixed base" } else { "floating base" }.to_owned(),
            description: &built.reading.description,
            model: &built.model,
            base: options.base,
            balls: Vec::new(),
            ground: None,
            projectile: None,
            is_live: true,
        };
        let recording = Recording { t: vec![0.0], q: q.to_vec(), ..Recording::of(&built.model) };
        let html = page::html(&recording, &setting, &meshes).map_err(|error| Failure::tool(&error))?;
        lines(meshes.into_warnings().warnings.iter()).iter().for_each(|line| console::warn(line));
        Ok(html)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(name: &str) -> Request {
        let robot = articulated_models::robot(name).unwrap();
        let mut request = Request::new(format!("{name}.urdf"), robot.urdf.as_bytes());
        request.options.robot.base = robot.base;
        request
    }

    #[test]
    fn a_still_page_names_its_bodies_and_fetches_nothing() {
        let (page, warnings) = page(&request("double_pendulum"), &[0.1, 0.2], "two </script>", &[] as &[&str]);
        let page = page.unwrap();
        assert!(warnings.is_empty() && !page.contains("http") && page.contains("two &lt;/script&gt;"), "{warnings:?}");
        let data = page.split("application/json\">").nth(1).unwrap().split("</script>").next().unwrap();
        let motion: serde_json::Value = serde_json::from_str(data).unwrap();
        assert_eq!((&motion["isLive"], &motion["moving"]), (&true.into(), &2.into()));
        assert_eq!(motion["bodies"].as_array().map(Vec::len), Some(2));
    }

    #[test]
    fn a_robot_without_inertia_has_a_page_too() {
        let text = "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>\
                    <joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>";
        let (page, _) = page(&Request::new("r.urdf", text.as_bytes()), &[0.0], "r", &[] as &[&str]);
        assert!(page.is_ok());
    }

    #[test]
    fn wrong_lengths_and_folders_are_refused() {
        let refused = |q: &[f64], packages: &[&str]| page(&request("double_pendulum"), q, "r", packages).0.unwrap_err().message;
        assert_eq!(refused(&[0.1], &[]), "q: found 1 numbers, expected 2");
        assert!(refused(&[0.1, 0.2], &["no/such"]).starts_with("packages: found no folder"));
    }
}
