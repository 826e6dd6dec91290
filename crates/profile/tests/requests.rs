//! Tests that any request returns a curve that keeps it, or a refusal that names a value that
//! works.

use carrystep_core::ProfileKind;
use carrystep_core::StartPhase;
use carrystep_profile::CurveFigures;
use carrystep_profile::reference::{
    Drive, Length, Listing, Quantity, ReferenceDistance, ReferenceError, ReferenceRequest, Scale,
    picture, write_csv,
};
use proptest::prelude::*;

const DRIVE: Drive = Drive { step_angle_deg: 1.8, microsteps: 2, travel_per_rev_mm: Some(5.0) };

fn any_length() -> impl Strategy<Value = Length> {
    prop_oneof![
        Just(Length::Step),
        Just(Length::Degree),
        Just(Length::Turn),
        Just(Length::Millimetre)
    ]
}

/// Mostly a value that suits a motor, and sometimes any value.
fn quantity(sane: std::ops::Range<f64>) -> impl Strategy<Value = Option<Quantity>> {
    let wild = prop_oneof![prop::num::f64::ANY, (-9_i32..16).prop_map(|power| 10_f64.powi(power))];
    let value = prop_oneof![9 => sane, 1 => wild];
    let some = (value, any_length(), any::<bool>()).prop_map(|(value, length, minute)| {
        let quantity = Quantity::new(value, length);
        if minute { quantity.per_minute() } else { quantity }
    });
    prop::option::weighted(0.8, some)
}

fn any_request() -> impl Strategy<Value = ReferenceRequest> {
    let travel = prop_oneof![
        Just(ReferenceDistance::Ramp),
        (1_u32..3000).prop_map(|steps| ReferenceDistance::Move(Quantity::new(
            f64::from(steps),
            Length::Step
        ))),
        (prop::num::f64::ANY, any_length())
            .prop_map(|(value, unit)| ReferenceDistance::Move(Quantity::new(value, unit))),
    ];
    let time = prop::option::weighted(0.4, prop_oneof![9 => 1e-3..10.0, 1 => prop::num::f64::ANY]);
    let centre = prop::option::weighted(0.1, prop_oneof![9 => -1.0..2.0, 1 => prop::num::f64::ANY]);
    let values = (quantity(1.0..5e3), quantity(0.0..100.0), quantity(1.0..1e5), quantity(1.0..1e6));
    (travel, time, centre, values).prop_map(
        |(travel, time, centre, (speed, start_speed, acceleration, jerk))| ReferenceRequest {
            drive: DRIVE,
            travel,
            time,
            speed,
            start_speed,
            acceleration,
            jerk,
            centre,
        },
    )
}

fn any_kind() -> impl Strategy<Value = ProfileKind> {
    prop::sample::select(ProfileKind::ALL)
}

/// Checks that no limit is exceeded. The speed limit of a ramp is its own top speed, and the jerk
/// of a trapezoid consists of impulses that do not count.
fn within(
    request: &ReferenceRequest,
    kind: ProfileKind,
    figures: &CurveFigures<f64>,
) -> Result<(), TestCaseError> {
    let limit = |quantity: Option<Quantity>| {
        quantity.map_or(f64::INFINITY, |q| {
            q.in_steps(&DRIVE).expect("a drive with a travel") * (1.0 + 1e-9)
        })
    };
    prop_assert!(figures.peak_acceleration <= limit(request.acceleration), "{figures:?}");
    prop_assert!(figures.top_speed <= limit(request.speed), "{figures:?}");
    prop_assert!(figures.peak_jerk <= limit(request.jerk), "{figures:?}");
    let jumps = [ProfileKind::Ranade, ProfileKind::Scurve, ProfileKind::Constant].contains(&kind);
    if jumps {
        prop_assert!(
            figures.start_speed
                <= limit(request.start_speed.or(Some(Quantity::new(0.0, Length::Step))))
        );
    }
    Ok(())
}

/// Raises the limits one after the other to the values that the refusals name, until the profile is
/// possible. A limit that is met to the last digit leaves little for the next one, so that one
/// limit may be named twice.
fn raised(mut request: ReferenceRequest, kind: ProfileKind) -> Result<(), TestCaseError> {
    for _ in 0..6 {
        let Err(ReferenceError::Refused { limit, wanted, unit, .. }) = request.reference(kind)
        else {
            prop_assert!(request.reference(kind).is_ok(), "{:?}", request.reference(kind));
            return Ok(());
        };
        if !(1e-9..1e12).contains(&wanted) {
            return Ok(());
        }
        let slot = match limit {
            "a start speed" => &mut request.start_speed,
            "a speed limit" => &mut request.speed,
            "an acceleration limit" => &mut request.acceleration,
            _ => &mut request.jerk,
        };
        let stated = slot.unwrap_or(Quantity::new(0.0, Length::Step));
        let again = Quantity::new(wanted, stated.length());
        let again = if unit == stated.per_minute().unit(1) { again.per_minute() } else { again };
        *slot = Some(again);
        if limit == "a start speed" && request.speed.is_some() {
            return Ok(());
        }
    }
    Err(TestCaseError::fail(format!("refused a seventh time: {:?}", request.reference(kind))))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_request_returns_a_consistent_profile_or_an_error(request in any_request(), kind in any_kind()) {
        match request.reference(kind) {
            Ok(reference) => {
                let figures = reference.figures();
                prop_assert!(figures.seconds > 0.0 && figures.seconds.is_finite(), "{figures:?}");
                prop_assert!(figures.steps > 0.0 && figures.top_speed > 0.0, "{figures:?}");
                prop_assert!(figures.peak_acceleration.is_finite() && figures.peak_jerk.is_finite(), "{figures:?}");
                within(&request, kind, figures)?;
                if let Some(time) = request.time {
                    prop_assert!((figures.seconds / time - 1.0).abs() < 1e-9, "{time}: {figures:?}");
                }
                if reference.whole_steps() < 5000.0 {
                    for phase in [StartPhase::Zero, StartPhase::Half] {
                        let listing = Listing { phase, clock_hz: Some(1e6) };
                        let rows: Vec<_> = reference.rows(&listing).expect("rows").collect();
                        prop_assert!(rows.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s));
                        let sum: f64 = rows.iter().filter_map(|row| row.delay_s).sum();
                        let [first, end] = [rows.first(), rows.last()].map(|row| row.expect("a row").time_s);
                        prop_assert!((sum - (end - first)).abs() <= 1e-6 * end, "{phase:?}: {sum} {first} {end}");
                    }
                }
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    #[test]
    fn values_named_by_a_refusal_make_the_profile_possible(request in any_request(), kind in any_kind()) {
        if let Err(ReferenceError::Refused { least_time, .. }) = request.reference(kind) {
            if let Some(time) = least_time.filter(|time| (1e-9..1e12).contains(time)) {
                let later = ReferenceRequest { time: Some(time), ..request.clone() };
                prop_assert!(later.reference(kind).is_ok(), "{time}: {:?}", later.reference(kind));
            }
            raised(request, kind)?;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_profile_can_be_drawn(request in any_request(), kind in any_kind()) {
        if let Ok(reference) = request.reference(kind) {
            let svg = picture(&[reference], Scale::STEPS).expect("a picture");
            prop_assert!(!svg.contains("NaN") && !svg.contains("inf"));
        }
    }
}

#[test]
fn csv_of_a_profile_that_cannot_be_listed_stays_empty() {
    let long = ReferenceRequest {
        acceleration: Some(Quantity::new(1e5, Length::Step)),
        ..ReferenceRequest::new(DRIVE, ReferenceDistance::Move(Quantity::new(1e9, Length::Step)))
    };
    let short = ReferenceRequest {
        travel: ReferenceDistance::Move(Quantity::new(10.0, Length::Step)),
        ..long.clone()
    };
    let both = [
        short.reference(ProfileKind::Sine).expect("a sine"),
        long.reference(ProfileKind::Sine).expect("a sine"),
    ];
    let mut text = Vec::new();
    assert!(write_csv(&mut text, &both, &Listing::SOURCES).is_err());
    assert!(
        write_csv(&mut text, &both[..1], &Listing { clock_hz: Some(f64::NAN), ..Listing::SOURCES })
            .is_err()
    );
    assert!(text.is_empty());
}
