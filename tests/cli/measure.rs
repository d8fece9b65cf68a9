//! Meters and what they read.

use std::f64::consts::PI;

use serde_json::Value;

use super::checkpoints::devices;
use super::*;

/// A black floor below a round lamp and a lamp of no extent. From straight below, the round one gives πL(R/d)².
const LAMPS: &str = "[camera]\nposition = [0, 2, 6]\nlook_at = [0, 1, 0]\nvfov = 40\n\
    [[material]]\nname = 'black'\ntype = 'diffuse'\nreflectance = 0\n[[material]]\nname = 'lamp'\ntype = 'emissive'\nradiance = [10, 5, 2.5]\n\
    [[shape]]\ntype = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = 'black'\n\
    [[shape]]\ntype = 'sphere'\ncenter = [0, 3, 0]\nradius = 0.5\nmaterial = 'lamp'\n\
    [[light]]\ntype = 'point'\nposition = [1, 1, 0]\nintensity = [1, 0, 0]\n\
    [[meter]]\nname = 'below'\ntype = 'irradiance'\nposition = [0, 0, 0]\nnormal = [0, 3, 0]\n\
    [[meter]]\nname = 'lamp'\ntype = 'radiance'\nposition = [0, 0.5, 0]\ndirection = [0, 1, 0]\n\
    [[meter]]\nname = 'outside'\ntype = 'distant'\ndirection = [0, -1, 0]\ntarget = [0, 3, 0]\n\
    [[meter]]\nname = 'window'\ntype = 'distant'\ndirection = [0, 0, -1]\ntarget = [0, 3, 0]\nsize = 2\n";

/// A rectangle in the open, as Mitsuba says it.
const RECTANGLE: &str = "<scene version='3.0.0'><emitter type='constant'><rgb name='radiance' value='0.5,0.25,1'/></emitter>\
    <shape type='rectangle'><transform name='to_world'><rotate x='1' angle='-90'/><scale x='2' z='1.5'/><translate x='3' y='1'/></transform>\
    <bsdf type='diffuse'/><sensor type='irradiancemeter' id='floor'/></shape>\
    <shape type='sphere'><point name='center' x='30'/><float name='radius' value='0.5'/><bsdf type='diffuse'/>\
    <sensor type='irradiancemeter' id='ball'/></shape>\
    <shape type='disk'><transform name='to_world'><rotate x='1' angle='-90'/><scale value='0.5'/><translate x='-30'/></transform>\
    <bsdf type='diffuse'/><sensor type='irradiancemeter' id='disk'/></shape>\
    <shape type='cube'><transform name='to_world'><translate y='-90'/></transform><sensor type='irradiancemeter' id='cube'/></shape>\
    <sensor type='perspective'><float name='fov' value='40'/></sensor>\
    <sensor type='radiancemeter' id='ray'><point name='origin' x='0' y='4' z='0'/><vector name='direction' x='0' y='1' z='0'/></sensor>\
    <sensor type='distant' id='far'><vector name='direction' x='0' y='1' z='0'/><point name='target' x='9' y='0' z='0'/></sensor></scene>";

fn measured(place: &Workplace, arguments: &str) -> Vec<Value> {
    let output = place.run(&format!("measure {arguments} --json -q"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    report["meters"].as_array().expect("a list").clone()
}

/// A meter's intervals hold these values, and not values that are 2 % larger, which is the control.
fn assert_reads(meters: &[Value], name: &str, truth: [f64; 3]) {
    let meter = meters.iter().find(|meter| meter["name"] == name).unwrap_or_else(|| panic!("no {name}: {meters:?}"));
    for (channel, truth) in truth.into_iter().enumerate() {
        let end = |end: &str| meter["channels"][channel][end].as_f64().expect("a number");
        let holds = |value: f64| (end("low") * (1.0 - 2e-5)..=end("high") * (1.0 + 2e-5)).contains(&value);
        assert!(holds(truth), "{name}: {truth} in {}", meter["channels"][channel]);
        assert!(!holds(1.02 * truth) || truth == 0.0, "{name}: 2 % more than {truth} in {}", meter["channels"][channel]);
    }
}

#[test]
#[ignore = "slow"]
fn meters_read_what_formulas_say() {
    let place = Workplace::new();
    fs::write(place.path("lamps.toml"), LAMPS).expect("a scene");
    for device in devices() {
        let meters = measured(&place, &format!("lamps.toml --device {device} --target-interval 0.5%"));
        let round = PI * (0.5_f64 / 3.0).powi(2);
        // The other lamp is √2 away, and its light falls in at 45°.
        let other = 0.5 * 0.5_f64.sqrt();
        assert_reads(&meters, "below", [10.0 * round + other, 5.0 * round, 2.5 * round]);
        assert_reads(&meters, "lamp", [10.0, 5.0, 2.5]);
        assert_reads(&meters, "outside", [10.0, 5.0, 2.5]);
        // A disk of radius 1/2 in a window of 2 by 2; the floor below is black, and so is what lies around.
        let share = PI * 0.25 / 4.0;
        assert_reads(&meters, "window", [10.0 * share, 5.0 * share, 2.5 * share]);
        // The paper lies so near that a lamp with hardly any noise is not brighter by that.
        fs::write(place.path("one.toml"), LAMPS.replace("intensity = [1, 0, 0]", "intensity = 0")).expect("a scene");
        let alone = measured(&place, &format!("one.toml --device {device} --target-interval 0.2% --meter below"));
        assert_reads(&alone, "below", [10.0 * round, 5.0 * round, 2.5 * round]);
        let below = &meters[0];
        let [red, green, blue] = [0, 1, 2].map(|channel| below["channels"][channel]["value"].as_f64().expect("a number"));
        let lux = 683.0 * (0.2126 * red + 0.7152 * green + 0.0722 * blue);
        let stated = below["photometric"]["value"].as_f64().expect("a number");
        assert!((stated / lux - 1.0).abs() < 1e-3, "{stated} lx, and by hand {lux}");
        assert_eq!((&below["unit"], &below["photometric_unit"]), (&"W/m²".into(), &"lx".into()));
    }
}

/// A lamp of no extent and intensity 9 above round meters, beside which a black wall of the size of their papers would change nothing.
const ROUND: &str = "[camera]\nposition = [0, 2, 6]\nlook_at = [0, 1, 0]\nvfov = 40\n\
    [[light]]\ntype = 'point'\nposition = [0, 2, 0]\nintensity = [9, 4.5, 0.9]\n\
    [[material]]\nname = 'black'\ntype = 'diffuse'\nreflectance = 0\n\
    [[shape]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = 0.5\nmaterial = 'black'\n\
    [[meter]]\nname = 'ball'\ntype = 'irradiance'\ncenter = [0, 0, 0]\nradius = 0.5\n\
    [[meter]]\nname = 'disk'\ntype = 'irradiance'\ncenter = [0, 1, 0]\nnormal = [0, 2, 0]\nradius = 1.5\n\
    [[meter]]\nname = 'away'\ntype = 'irradiance'\ncenter = [0, 1, 0]\nnormal = [0, -1, 0]\nradius = 1.5\n";

/// The flux of a lamp through a disk or onto a ball is its intensity times the solid angle, and the irradiance that over the area.
#[test]
#[ignore = "slow"]
fn round_meters_read_the_flux_over_their_area() {
    let place = Workplace::new();
    fs::write(place.path("round.toml"), ROUND).expect("a scene");
    let solid_angle = |cosine: f64| 2.0 * PI * (1.0 - cosine);
    let ball = solid_angle((1.0 - 0.25_f64.powi(2)).sqrt()) / (4.0 * PI * 0.25);
    let disk = solid_angle(1.0 / (1.0 + 1.5_f64.powi(2)).sqrt()) / (PI * 1.5 * 1.5);
    for device in devices() {
        let meters = measured(&place, &format!("round.toml --device {device} --target-interval 0.5%"));
        assert_reads(&meters, "ball", [9.0 * ball, 4.5 * ball, 0.9 * ball]);
        assert_reads(&meters, "disk", [9.0 * disk, 4.5 * disk, 0.9 * disk]);
        assert_reads(&meters, "away", [0.0; 3]);
        // Far from the origin and tiny, where single precision resolves less; a sky of radiance 1 gives π everywhere.
        let sky = ROUND.replace(
            "[[light]]\ntype = 'point'\nposition = [0, 2, 0]\nintensity = [9, 4.5, 0.9]",
            "[[light]]\ntype = 'environment'\nradiance = 1",
        );
        let far = sky.replace("center = [0, 0, 0]\nradius = 0.5", "center = [0, 400, 0]\nradius = 0.03");
        fs::write(place.path("far.toml"), far).expect("a scene");
        let meters = measured(&place, &format!("far.toml --device {device} --target-interval 0.5% --meter ball"));
        assert_reads(&meters, "ball", [PI; 3]);
    }
}

/// Mitsuba's sensors become meters, and scene files that are written of them read the same.
#[test]
fn meters_of_mitsuba_are_imported() {
    let place = Workplace::new();
    fs::write(place.path("room.xml"), RECTANGLE).expect("a scene");
    let meters = measured(&place, "room.xml --device cpu --target-interval 0.5%");
    assert_reads(&meters, "floor", [0.5 * PI, 0.25 * PI, PI]);
    for open in ["ball", "disk"] {
        assert_reads(&meters, open, [0.5 * PI, 0.25 * PI, PI]);
    }
    assert_reads(&meters, "ray", [0.5, 0.25, 1.0]);
    assert_reads(&meters, "far", [0.5, 0.25, 1.0]);
    assert_eq!(meters.iter().map(|meter| &meter["interval"]["by"]).collect::<Vec<_>>(), ["bound"; 5]);
    place.expect(0, "import room.xml -o room.toml");
    let again = measured(&place, "room.toml --device cpu --target-interval 0.5% --meter floor");
    let floor = meters.iter().find(|meter| meter["name"] == "floor").expect("it is there");
    assert_eq!((again.len(), &again[0]["channels"]), (1, &floor["channels"]));
    // And Mitsuba's format says those that stand on no shape.
    let said = place.expect(0, "export room.toml -o again.xml");
    assert!(said.contains("meter[2]") || said.contains("meter"), "{said}");
    let names: Vec<Value> = measured(&place, "again.xml --device cpu").iter().map(|meter| meter["type"].clone()).collect();
    assert_eq!(names, ["radiance", "distant"]);
}

#[test]
fn meters_that_make_no_sense_are_refused() {
    let place = Workplace::new();
    let said = place.expect(2, "measure scene.toml");
    assert!(said.contains("has no meter"), "{said}");
    fs::write(place.path("lamps.toml"), LAMPS).expect("a scene");
    let said = place.expect(2, "measure lamps.toml --meter lux");
    assert!(said.contains("there is no such meter") && said.contains("below, lamp"), "{said}");
    for (wrong, why) in [
        ("type = 'irradiance'\nposition = [0, 0, 0]", "`position` and `normal` (a point)"),
        ("type = 'irradiance'\nposition = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1", "`center`, `normal` and `radius` (a disk)"),
        ("type = 'irradiance'\ncenter = [0, 0, 0]\nradius = 0", "radius"),
        ("type = 'irradiance'\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [1, 1, 0]", "right angle"),
        ("type = 'radiance'\nposition = [0, 0, 0]\ndirection = [0, 0, 0]", "points nowhere"),
        ("type = 'radiance'\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nmedium = 'fog'", "fog"),
        ("type = 'distant'\ndirection = [0, 0, 1]\nsize = -1", "size"),
        ("type = 'luminance'", "luminance"),
    ] {
        fs::write(place.path("wrong.toml"), format!("{LAMPS}[[meter]]\nname = 'wrong'\n{wrong}\n")).expect("a scene");
        let said = place.expect(3, "measure wrong.toml");
        assert!(said.contains(why) && said.contains("wrong.toml:"), "{wrong}: {said}");
    }
    fs::write(
        place.path("twice.toml"),
        format!("{LAMPS}{}", LAMPS.split("[[meter]]").nth(1).map(|meter| format!("[[meter]]{meter}")).expect("a meter")),
    )
    .expect("a scene");
    assert!(place.expect(3, "measure twice.toml").contains("two meters named `below`"));
    let csv = place.run("measure lamps.toml --device cpu --csv -q --meter lamp");
    let lines: Vec<String> = text(&csv.stdout).lines().map(str::to_owned).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0].split(',').count(), lines[1].split(',').count(), "{lines:?}");
    assert!(lines[1].starts_with("\"lamp\",radiance,W/(m² sr),10,"), "{}", lines[1]);
}
