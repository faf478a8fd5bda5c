//! Tests of the gap between the bounds of functions and of fluxes.

use super::*;
use crate::sample;

/// The difference of a function and a flux is known by cells and, independently, in total: for the
/// mean time from the flux's cost and the function's integral. It is at least 0, and both values
/// agree only if the flux's source is where the load is. Here most of the load is far from contact.
#[test]
fn the_gap_of_the_mean_time_is_the_same_by_cells_and_in_all() {
    let problem = sample::one_face();
    let bond = problem.pair.as_ref().unwrap().bound;
    let field = Field::fitted(&problem, 8e-3, 0.61, 0.0, &[bond]).unwrap();
    let mesh = &field.mesh;
    let nodes = Nodes::new(mesh);
    let held = mesh.holding(&bond);
    let pins = nodes.pins(mesh, 1, |id| held.contains(&id).then_some(0));
    let left_out = vec![false; mesh.leaves.len()];
    let network = field.network(&nodes, &pins, 1).unwrap();
    let loads = loads(mesh, &nodes, &left_out);
    let system = System::new(mesh, &nodes, &pins);
    let [time] = system.solve([system.loaded(&loads, None)]).unwrap();
    let source = |cell: usize| mesh.held(cell);
    let like = network.potentials(&nodes, &time);
    let fluxes = network.fluxes(&source, &[like]).unwrap();
    let held: f64 = time.iter().zip(&loads).map(|(a, b)| a * b).sum();
    let gap = Gap {
        flux: &fluxes[0],
        values: &time,
        source: &source,
    };
    let by_cells: f64 = network.products(mesh, &nodes, &gap, &gap).iter().sum();
    let in_all = fluxes[0].cost - held;
    assert!(
        (by_cells / in_all - 1.0).abs() < 0.15,
        "{by_cells} {in_all}"
    );
}
