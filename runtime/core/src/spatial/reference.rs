//! Reference of the six numbers of a frame's twist or wrench.

/// A choice of axes and of the point that linear velocities and moments are taken at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reference {
    /// Axes of the frame, about its origin.
    #[default]
    Body,
    /// Axes of the world frame, about the world frame's origin; also called spatial.
    World,
    /// Axes of the world frame, about the frame's origin: [ω; ṗ].
    WorldAligned,
}

impl Reference {
    /// Its name in settings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Body => "body",
            Self::World => "world",
            Self::WorldAligned => "world_aligned",
        }
    }
}
