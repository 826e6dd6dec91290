//! Pages of the documentation in tests, and numbers as the pages write them.

/// Asserts that the page of this name contains each of these texts, regardless of line breaks.
#[track_caller]
pub fn says(name: &str, page: &str, texts: &[String]) {
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    for text in texts {
        assert!(page.contains(text.as_str()), "{name} does not say: {text}");
    }
}

/// Groups digits in threes: 61468.3 becomes "61 468".
pub fn grouped(x: f64) -> String {
    let digits = format!("{x:.0}");
    let group = |(i, c): (usize, char)| {
        let first_of_three = i > 0 && (digits.len() - i).is_multiple_of(3);
        first_of_three.then_some(' ').into_iter().chain([c])
    };
    digits.chars().enumerate().flat_map(group).collect()
}
