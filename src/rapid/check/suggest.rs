//! Names that may be meant.

/// The nearest of some names, if it is near enough to be meant.
pub(super) fn nearest<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let lower = name.to_lowercase();
    let most = if lower.chars().count() < 5 { 1 } else { 2 };
    let distance = |other: &str| strsim::damerau_levenshtein(&lower, &other.to_lowercase());
    let near = known.map(|other| (distance(other), other)).filter(|(far, _)| *far <= most);
    near.min().map(|(_, other)| other)
}

/// Whether one name is the other with a typing error: two neighbouring letters swapped, or one
/// letter inside the word missing or doubled. Names in a series (`p10`, `p20`; `gripL`, `gripR`)
/// differ otherwise.
pub(super) fn is_slip(name: &str, meant: &str) -> bool {
    let (name, meant) = (name.to_lowercase(), meant.to_lowercase());
    let (a, b): (Vec<char>, Vec<char>) = (name.chars().collect(), meant.chars().collect());
    let (longest, shortest) = (a.len().max(b.len()), a.len().min(b.len()));
    if shortest < 4 || a == b {
        return false;
    }
    let first = a.iter().zip(&b).take_while(|(x, y)| x == y).count();
    let last = a.iter().rev().zip(b.iter().rev()).take_while(|(x, y)| x == y).count();
    if longest == shortest {
        let swapped =
            first + last + 2 == longest && a[first] == b[first + 1] && a[first + 1] == b[first];
        return swapped && a[first].is_alphabetic() && a[first + 1].is_alphabetic();
    }
    let more = if a.len() > b.len() { &a } else { &b };
    // The first place where a letter may be too many: of a doubled letter the first one.
    let place = shortest - last.min(shortest);
    // Inside: neither the first nor one of the last two letters, which often tell a series.
    longest == shortest + 1
        && first + last >= shortest
        && (1..longest - 2).contains(&place)
        && more[place].is_alphabetic()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_told_from_series() {
        for (name, meant) in [("pHoem", "pHome"), ("rPickPrat", "rPickPart"), ("pHomme", "pHome")] {
            assert!(is_slip(name, meant), "{name}");
        }
        let others =
            [("p10", "p20"), ("gripL", "gripR"), ("pPick12", "pPick21"), ("pHome", "pHome")];
        for (name, other) in others.into_iter().chain([("pPick", "pPicks"), ("rOpenA", "rOpenB")]) {
            assert!(!is_slip(name, other), "{name} {other}");
        }
    }

    #[test]
    fn the_nearest_name_is_the_same_for_any_order() {
        let names = ["pHome2", "pHome1", "other"];
        assert_eq!(nearest("pHome", names.into_iter()), Some("pHome1"));
        assert_eq!(nearest("pHome", names.into_iter().rev()), Some("pHome1"));
        assert_eq!(nearest("quite_different", names.into_iter()), None);
    }
}
