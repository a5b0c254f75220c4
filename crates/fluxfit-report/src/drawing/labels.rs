//! Places of labels beside their points, so that no label overprints another one or a point.

/// Size of a character, and half of a marker, pixels.
const CHARACTER: (i32, i32) = (8, 14);
const MARKER: i32 = 5;

/// Space between two labels side by side, pixels: less would make one number of two.
const BETWEEN: i32 = 6;

/// Smallest distance between two names below each other, pixels.
pub(crate) const NAMES_APART: i32 = 16;

/// The middle of each label, pixels; `None` where there is no room. A label is above its point, beside it, below it, or farther aside.
pub(crate) fn places(points: &[(i32, i32)], labels: &[String], (width, height): (i32, i32)) -> Vec<Option<(i32, i32)>> {
    let mut boxes: Vec<[i32; 4]> = points.iter().map(|(x, y)| [x - MARKER, y - MARKER, x + MARKER, y + MARKER]).collect();
    let mut places = Vec::new();
    for ((x, y), label) in points.iter().zip(labels) {
        let half = (label.chars().count() as i32 * CHARACTER.0 + BETWEEN) / 2;
        let (aside, above) = (half + MARKER, MARKER + 2 + CHARACTER.1 / 2);
        let far = aside + 2 * half + 4;
        let tried = [(0, -above), (aside, 0), (-aside, 0), (0, above), (far, 0), (-far, 0), (aside, -above), (-aside, -above)];
        let place = tried.into_iter().map(|(dx, dy)| (x + dx, y + dy)).find_map(|(x, y)| {
            let own = [x - half, y - CHARACTER.1 / 2, x + half, y + CHARACTER.1 / 2];
            let is_inside = own[0] >= 0 && own[1] >= 0 && own[2] <= width && own[3] <= height;
            let is_free = boxes.iter().all(|other| own[0] >= other[2] || own[2] <= other[0] || own[1] >= other[3] || own[3] <= other[1]);
            (is_inside && is_free).then_some(((x, y), own))
        });
        boxes.extend(place.map(|(_, own)| own));
        places.push(place.map(|(at, _)| at));
    }
    places
}

/// Ascending positions with a minimum distance, as close as possible to the wanted ones: positions that are too close form a group
/// about their mean.
pub(crate) fn spread(wanted: &[i32], apart: i32) -> Vec<i32> {
    // Each group: number of members, and the sum of the positions that its members want for the first one.
    let mut groups: Vec<(i32, i32)> = Vec::new();
    let first = |(count, sum): (i32, i32)| sum / count;
    for y in wanted {
        groups.push((1, *y));
        while let [.., (count, sum), (next_count, next_sum)] = groups[..]
            && first((next_count, next_sum)) < first((count, sum)) + count * apart
        {
            groups.truncate(groups.len() - 2);
            groups.push((count + next_count, sum + next_sum - next_count * count * apart));
        }
    }
    groups.into_iter().flat_map(|group| (0..group.0).map(move |k| first(group) + k * apart)).collect()
}

/// Characters of a name beside a point.
const NAME: usize = 14;

/// A motor's name, of a long one the end: files of one directory differ there.
pub(crate) fn short(name: &str) -> String {
    let letters = name.chars().count();
    if letters <= NAME { name.to_owned() } else { format!("…{}", name.chars().skip(letters + 1 - NAME).collect::<String>()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twenty_points_in_a_column_have_labels_that_do_not_overprint() {
        let points: Vec<(i32, i32)> = (0..20).map(|k| (300, 20 + 12 * k)).collect();
        let labels: Vec<String> = (1..=20).map(|k: i32| k.to_string()).collect();
        let placed: Vec<(i32, i32)> = places(&points, &labels, (600, 300)).into_iter().flatten().collect();
        assert_eq!(placed.len(), 20);
        for (k, one) in placed.iter().enumerate() {
            assert!(placed[..k].iter().all(|other| (one.0 - other.0).abs() >= 8 || (one.1 - other.1).abs() >= 14), "{placed:?}");
        }
    }

    #[test]
    fn a_label_without_room_is_left_out() {
        let points = [(50, 50); 20];
        let placed = places(&points, &vec!["10".to_owned(); 20], (100, 100));
        assert!(placed.iter().flatten().count() < 20 && placed[0].is_some());
    }

    #[test]
    fn a_long_name_is_known_by_its_end() {
        assert_eq!(["m7", "logs/2026/drive_0001.csv"].map(short), ["m7", "…rive_0001.csv"]);
    }

    #[test]
    fn names_keep_their_distance() {
        assert_eq!(spread(&[10, 100, 200], 16), [10, 100, 200]);
        assert_eq!(spread(&[100, 100], 16), [92, 108]);
        assert_eq!(spread(&[100, 100, 100, 300], 16), [84, 100, 116, 300]);
        // The second group is merged with the first.
        assert_eq!(spread(&[100, 104, 110], 16), [88, 104, 120]);
        assert!(spread(&[], 16).is_empty());
    }
}
