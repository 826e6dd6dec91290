//! Finds names that are similar to a misspelt one.

/// The known name that a misspelt one most likely means: only few letters differ. Case is ignored.
pub fn nearest<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const MOST_CHARS: usize = 64;
    if wrong.chars().nth(MOST_CHARS).is_some() {
        return None;
    }
    let wrong = wrong.to_lowercase();
    let most = (wrong.chars().count() / 3).max(1);
    let apart = |name: &'a str| (strsim::damerau_levenshtein(&wrong, &name.to_lowercase()), name);
    // A name must differ in fewer letters than it has; otherwise every name of one letter would
    // match.
    let close =
        |(distance, name): &(usize, &str)| *distance <= most && *distance < name.chars().count();
    known
        .into_iter()
        .map(apart)
        .filter(close)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}

/// The text " (did you mean 'x'?)" if a known name is similar, otherwise an empty text.
pub fn did_you_mean<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(wrong, known).map_or_else(String::new, |name| format!(" (did you mean '{name}'?)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIVERS: [&str; 4] = ["a4988", "drv8825", "tmc2209", "tmc2130"];

    #[test]
    fn similar_name_is_found() {
        for (wrong, name) in
            [("a4989", "a4988"), ("A4988", "a4988"), ("drv8285", "drv8825"), ("tmc220", "tmc2209")]
        {
            assert_eq!(nearest(wrong, DRIVERS), Some(name), "{wrong}");
        }
        assert_eq!(did_you_mean("a498", DRIVERS), " (did you mean 'a4988'?)");
    }

    #[test]
    fn unrelated_name_is_not_found() {
        for wrong in ["", "uln2003", "x", &"a".repeat(1_000_000)] {
            assert_eq!(nearest(wrong, DRIVERS), None);
        }
        assert_eq!(nearest("w", ["x", "y"]), None);
        assert_eq!(nearest("X", ["x", "y"]), Some("x"));
    }
}
