//! Tests of the clock solver against icestorm's `icepll` and against settings computed by hand.

#![allow(clippy::unwrap_used)] // a test may panic

use carrystep_boards::clock::{
    ClockManager, ClockManagers, Dcm, Ecp5Pll, GowinPll, Ice40Pll, Mmcm,
};
use std::process::Command;

/// Converts the MHz of a golden line, or of icepll's output, to Hz.
fn hz(mhz: &str) -> u64 {
    let (whole, part) = mhz.split_once('.').unwrap_or((mhz, ""));
    format!("{whole}{part:0<6}").parse().unwrap()
}

/// If icepll finds an exact setting, the solver must find the same one; otherwise the solver must
/// refuse the clock.
fn compare(input: &str, output: &str, settings: [u8; 4]) {
    let [divr, divf, divq, filter_range] = settings;
    let found = ClockManagers::Ice40.solve(hz(input), hz(output));
    let what = format!("{output} from {input}: {found:?}");
    if input == output {
        assert_eq!(found, Ok(ClockManager::Oscillator), "{what}");
        return;
    }
    match found {
        Ok(ClockManager::Ice40Pll(pll)) => {
            assert_eq!(pll, Ice40Pll { divr, divf, divq, filter_range }, "{what}");
        }
        Ok(other) => panic!("{other:?}: {what}"),
        Err(error) => {
            let (r, f) = (u64::from(divr) + 1, u64::from(divf) + 1);
            let (vco, divider) = (hz(input) * f, r << divq);
            assert_ne!(vco, hz(output) * divider, "{what}");
            // icepll also returns clocks that are not whole Hz, and some outside of the PLL's
            // output range.
            if vco.is_multiple_of(divider) && (16_000_000..=275_000_000).contains(&(vco / divider))
            {
                let off = |made: u64| made.abs_diff(hz(output));
                assert_eq!(error.nearest_hz.map(off), Some(off(vco / divider)), "{what}");
            }
        }
    }
}

#[test]
fn pll_settings_equal_those_of_icepll() {
    let mut lines = 0;
    for line in include_str!("icepll.txt").lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split(' ').collect();
        let settings = [2, 3, 4, 5].map(|word: usize| words[word].parse().unwrap());
        compare(words[0], words[1], settings);
        lines += 1;
    }
    assert_eq!(lines, 210);
}

/// Compares the golden lines with the installed icepll, if there is one.
#[test]
fn golden_lines_equal_the_output_of_icepll() {
    for line in include_str!("icepll.txt").lines().filter(|line| !line.starts_with('#')).step_by(7)
    {
        let words: Vec<&str> = line.split(' ').collect();
        let Ok(output) = Command::new("icepll").args(["-i", words[0], "-o", words[1]]).output()
        else {
            return;
        };
        let said = String::from_utf8(output.stdout).unwrap();
        let number = |key: &str| {
            let (_, rest) = said.split_once(key).unwrap();
            rest.split_whitespace().next().unwrap().to_owned()
        };
        let found = ["DIVR:", "DIVF:", "DIVQ:", "FILTER_RANGE:"].map(number);
        assert_eq!(found, [2, 3, 4, 5].map(|word: usize| words[word].to_owned()), "{line}");
    }
}

#[test]
fn spartan_settings_equal_those_computed_by_hand() {
    let spartan3 = carrystep_boards::Family::Spartan3.facts().clock_managers();
    let dcm = |multiply, divide| Ok(ClockManager::Dcm(Dcm { multiply, divide }));
    assert_eq!(spartan3.solve(50_000_000, 80_000_000), dcm(8, 5));
    assert_eq!(spartan3.solve(32_000_000, 40_000_000), dcm(5, 4));
    // 12 MHz x 2 / 3 would give this clock, but it is below the range of the synthesiser.
    let refused = spartan3.solve(12_000_000, 8_000_000).unwrap_err();
    assert_eq!(refused.nearest_hz, Some(18_000_000));
    // 720 MHz / 9 is the only VCO clock of 12 MHz that divides to 80 MHz, and also to 40 MHz.
    let mmcm = |out_divide| Ok(ClockManager::Mmcm(Mmcm { multiply: 60, divide: 1, out_divide }));
    assert_eq!(ClockManagers::Mmcm.solve(12_000_000, 80_000_000), mmcm(9));
    assert_eq!(ClockManagers::Mmcm.solve(12_000_000, 40_000_000), mmcm(18));
}

/// 400 and 800 MHz are the only VCO clocks of 25 MHz that divide to 80 MHz, and are as near to the
/// middle of the range; 600 MHz, the middle, divides to 40 MHz. Of 48 MHz, 480 and 720 MHz are as
/// near to it.
#[test]
fn ecp5_settings_equal_those_computed_by_hand() {
    let pll = |divide, multiply, out_divide| {
        Ok(ClockManager::Ecp5Pll(Ecp5Pll { divide, multiply, out_divide }))
    };
    let solve = |from, to| ClockManagers::Ecp5.solve(from, to);
    assert_eq!(solve(25_000_000, 80_000_000), pll(1, 32, 10));
    assert_eq!(solve(25_000_000, 40_000_000), pll(1, 24, 15));
    assert_eq!(solve(48_000_000, 80_000_000), pll(1, 15, 9));
    assert_eq!(solve(48_000_000, 40_000_000), pll(1, 15, 18));
    // It would need a VCO of 1200 MHz.
    assert_eq!(solve(25_000_000, 48_000_000).unwrap_err().nearest_hz, Some(47_656_250));
}

/// 48 / 27 is 16 / 9, so that the phase detector has 3 MHz, its least frequency. Of 48 MHz, only 16
/// times it, 768 MHz, is a clock that the VCO has. 54 MHz needs no divider of the reference; 864
/// MHz is nearer to the middle, 850 MHz, than 432 MHz, which the VCO does not have.
#[test]
fn gowin_settings_equal_those_computed_by_hand() {
    let pll = |divide, multiply, out_divide| {
        Ok(ClockManager::GowinPll(GowinPll { divide, multiply, out_divide }))
    };
    let solve = |from, to| ClockManagers::Gowin.solve(from, to);
    assert_eq!(solve(27_000_000, 48_000_000), pll(9, 16, 16));
    assert_eq!(solve(27_000_000, 54_000_000), pll(1, 2, 16));
    // 40 / 27 would need a phase detector of 1 MHz.
    assert_eq!(solve(27_000_000, 40_000_000).unwrap_err().nearest_hz, Some(40_500_000));
}

#[test]
fn extreme_frequencies_do_not_panic() {
    let spartan6 = carrystep_boards::Family::Spartan6.facts().clock_managers();
    let plls = [ClockManagers::Ice40, ClockManagers::Ecp5, ClockManagers::Gowin];
    for managers in plls.into_iter().chain([ClockManagers::Mmcm, spartan6]) {
        for oscillator in [0, 1, 12_000_000, u64::MAX] {
            for wanted in [1, 48_000_000, u64::MAX - 1] {
                assert!(
                    [12_000_000, wanted].contains(&oscillator)
                        || managers.solve(oscillator, wanted).is_err(),
                    "{oscillator} {wanted}"
                );
            }
        }
    }
}
