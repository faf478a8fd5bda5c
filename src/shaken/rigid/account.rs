//! What became of the energy.

/// The energy balance since the start (J).
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Account {
    /// Work by shaking, fans and the table's motion.
    pub work: f64,
    /// Lost in contact: less the work of all impulses, each times the mean of the velocities before and
    /// after it.
    pub contact_loss: f64,
    /// Lost to drag.
    pub drag_loss: f64,
    /// Lost to friction on the table: less the work of its impulses.
    #[serde(default)]
    pub table_loss: f64,
}

impl Account {
    /// Adds what became of the energy elsewhere or later.
    pub fn add(&mut self, other: &Self) {
        self.work += other.work;
        self.contact_loss += other.contact_loss;
        self.drag_loss += other.drag_loss;
        self.table_loss += other.table_loss;
    }
}
