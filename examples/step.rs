include!("try_tile.rs");
fn main() {
    let p = paper();
    let q: Configuration = [-0.3188098, -0.456433213, -2.5895739].into();
    let q = landscape::slide::settle(&p, &q, 1e-3).unwrap();
    let n = p.contact.as_ref().unwrap().constraints(&q, 1e-5);
    println!("{q:?} {n:?}");
    let mut pt = landscape::slide::Point::new(&p, q);
    let mut size = 5e-3;
    for _ in 0..30 {
        let m = p.mass_metric(pt.q.theta);
        match landscape::slide::step_downhill(&p, &pt, size) {
            Some(n) => {
                let mv = landscape::slide::length(&pt.q.step_to(&n.q), &m);
                println!(
                    "size {size:.2e} moved {mv:.3e} {:?} dU {:.3e} cl {:.2e}",
                    n.q.to_array(),
                    n.energy - pt.energy,
                    p.clearance(&n.q)
                );
                pt = n;
                if mv > 0.5 * size {
                    size = (1.5 * size).min(5e-3);
                } else if mv < 0.05 * size {
                    size *= 0.5
                }
            }
            None => {
                println!("size {size:.2e} refused");
                size *= 0.5
            }
        }
    }
}
