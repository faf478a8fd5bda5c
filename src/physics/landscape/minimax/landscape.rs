//! What barriers are certified of: an energy over the free configurations of a space.

use super::CertifyError;
use super::lower::{Assessment, assess};
use super::upper::PathProof;
use crate::cell::Cell;
use crate::configuration::{Configuration, ConfigurationSpace};
use crate::contact::Contact;
use crate::contact::cells::ContactCells;
use crate::landscape::metered::Metered;
use crate::potential::bounds::CellBounds;

/// The tiles' contact, in the forms that the two bounds need.
struct Obstacles<'a> {
    contact: &'a Contact,
    cells: ContactCells,
}

pub(super) struct Landscape<'a> {
    pub bounds: Metered<'a>,
    obstacles: Option<Obstacles<'a>>,
    pub space: &'a ConfigurationSpace,
    /// How far (m) a turn by one radian moves the tile's farthest point.
    lever: f64,
}

impl<'a> Landscape<'a> {
    pub fn new(
        bounds: &'a dyn CellBounds,
        contact: Option<&'a Contact>,
        space: &'a ConfigurationSpace,
    ) -> Self {
        Self {
            bounds: Metered::new(bounds),
            obstacles: contact.map(|contact| Obstacles {
                contact,
                cells: ContactCells::new(contact),
            }),
            space,
            lever: contact.map_or(space.rho, |contact| contact.moving().circumradius()),
        }
    }

    /// Whether a path may start or end here.
    pub fn check(&self, q: &Configuration) -> Result<(), CertifyError> {
        if !self.space.contains(q) {
            return Err(CertifyError::OffTheTable(*q));
        }
        match &self.obstacles {
            Some(obstacles) if !obstacles.contact.is_free(q) => Err(CertifyError::NotFree(*q)),
            _ => Ok(()),
        }
    }

    /// Assesses a cell; `None` where it is proved blocked.
    pub fn assess(&self, cell: &Cell) -> Option<Assessment> {
        let contact = self.obstacles.as_ref().map(|obstacles| &obstacles.cells);
        assess(&self.bounds, contact, self.lever, cell)
    }

    pub fn proof(&self) -> PathProof<'_> {
        PathProof {
            bounds: &self.bounds,
            contact: self.obstacles.as_ref().map(|obstacles| obstacles.contact),
            space: self.space,
        }
    }

    /// A configuration with the tiles far apart, near the middle of a cell that holds one; `None`
    /// if the cell is proved to hold none.
    pub fn far_end(&self, cell: &Cell) -> Option<Configuration> {
        let farthest = farthest(cell);
        if !self.space.is_far(&farthest) {
            return None;
        }
        let centre = cell.centre;
        let stretch = self.space.free_distance / libm::hypot(centre.x, centre.y);
        let stretch = stretch.max(1.0) * (1.0 + 1e-12);
        let near = Configuration::new(centre.x * stretch, centre.y * stretch, centre.theta);
        let fits = self.space.contains(&near) && self.space.is_far(&near);
        Some(if fits { near } else { farthest })
    }
}

/// The configuration of a cell that is farthest from the origin in the plane, at the cell's middle
/// angle.
fn farthest(cell: &Cell) -> Configuration {
    let away = |centre: f64, half: f64| centre + half.copysign(centre);
    Configuration::new(
        away(cell.centre.x, cell.half[0]),
        away(cell.centre.y, cell.half[1]),
        cell.centre.theta,
    )
}
