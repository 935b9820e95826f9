//! Errors of the generator, where they show.

use articulated_codegen::scene::articulated_scene::{At, Scene, SceneError, SceneErrors};
use articulated_codegen::scene::placed;
use articulated_codegen::{Error, RobotError};

use crate::settings::Settings;

impl Settings {
    /// Each of several errors at the word of the invocation that it is about, or else at the robot's file.
    pub(crate) fn at_their_words(&self, error: Error, scene: &Scene) -> Vec<syn::Error> {
        let robot = self.at_robot(scene);
        let each = |error: Error| -> Vec<syn::Error> {
            match error {
                Error::Robot(RobotError::Scene(SceneErrors { errors })) => errors.iter().map(|error| self.in_scene(error)).collect(),
                Error::Robot(RobotError::Urdf(problems)) => problems.errors.iter().map(|one| self.places.error(robot, one)).collect(),
                other => vec![self.places.error(robot, other)],
            }
        };
        placed(error, scene).into_each().into_iter().flat_map(each).collect()
    }

    /// A mistake in what the invocation says, at its word; one in the scene's file, where that is named.
    pub(crate) fn in_scene(&self, error: &SceneError) -> syn::Error {
        match error.at {
            At::Word(_) => self.places.error(error.at, error.message()),
            _ => self.places.error(self.at_scene(), error),
        }
    }

    /// Where the robot's file is named: in the invocation, or in the scene.
    pub(crate) fn at_robot(&self, scene: &Scene) -> At {
        self.here(scene.code.places.robot)
    }

    /// A place in the invocation as it is; for one in the scene, that where the scene is named.
    pub(crate) fn here(&self, at: At) -> At {
        if matches!(at, At::Word(_)) { at } else { self.at_scene() }
    }

    fn at_scene(&self) -> At {
        self.own.scene.as_ref().map_or(At::Nowhere, |(_, at)| *at)
    }
}
