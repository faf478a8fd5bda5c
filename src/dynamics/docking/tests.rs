use super::*;
use crate::dynamics::tests::paper_tile;

#[test]
fn probe() {
    let design = paper_tile();
    let n: usize = std::env::var("N").map_or(200, |n| n.parse().unwrap());
    for h in [1e-3, 2e-4] {
        let mut settings = DockingSettings::engine_comparison();
        settings.runs = n;
        settings.motion.contact_step = h;
        let d = dock(&design, &settings, &|| ()).unwrap();
        println!(
            "{h}: bound {:?} misbound {:?} free {:?}",
            d.bound, d.misbound, d.free
        );
        for t in &d.traps {
            println!("   {t:?}");
        }
        let c: usize = d.runs.iter().map(|r| r.contact_steps).sum();
        let f: usize = d.runs.iter().map(|r| r.free_steps).sum();
        println!(
            "   wall {} contact {c} free {f} sim s per wall s {}",
            d.wall_s,
            n as f64 * 5.0 / d.wall_s
        );
        println!(
            "   best {:?}",
            super::map::share_within(&d, [-2.0, 2.0], [0.2, 0.6])
        );
        for w in 0..6 {
            let a = 0.2 * w as f64;
            println!(
                "   {a:.1}: {:?}",
                super::map::share_within(&d, [-2.0, 2.0], [a, a + 0.2])
            );
        }
        println!(
            "{:?}",
            OnRate {
                times: vec![],
                ..OnRate::new(&d)
            }
        );
    }
}
