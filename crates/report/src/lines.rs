//! Ticks of each cause in each line, in bounded memory: from some length of the file on,
//! neighbouring lines are counted together.

/// Most groups of lines.
const MOST: usize = 1024;

/// Ticks by line and cause.
#[derive(Debug, Clone)]
pub(crate) struct LineTicks {
    causes: usize,
    /// Number of lines in a group: a power of two.
    together: u64,
    /// For each group the ticks of each cause.
    groups: Vec<Vec<u64>>,
}

impl LineTicks {
    pub fn new(causes: usize) -> Self {
        Self { causes, together: 1, groups: Vec::new() }
    }

    /// Number of lines in a group. Group k has the lines from k times this number on.
    pub fn together(&self) -> u64 {
        self.together
    }

    /// For each group the ticks of each cause.
    pub fn groups(&self) -> &[Vec<u64>] {
        &self.groups
    }

    pub fn add(&mut self, line: u64, cause: usize, ticks: u64) {
        while line / self.together >= MOST as u64 {
            self.together *= 2;
            let pairs = self.groups.chunks(2).map(|pair| {
                let sum = |cause| pair.iter().map(|group| group[cause]).sum();
                (0..self.causes).map(sum).collect()
            });
            self.groups = pairs.collect();
        }
        let group = (line / self.together) as usize;
        if self.groups.len() <= group {
            self.groups.resize(group + 1, vec![0; self.causes]);
        }
        self.groups[group][cause] += ticks;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_keep_all_ticks_where_they_belong() {
        let mut lines = LineTicks::new(2);
        for line in 1..=5000_u64 {
            lines.add(line, (line % 2) as usize, line);
        }
        assert_eq!(lines.together(), 8);
        for (number, group) in lines.groups().iter().enumerate() {
            let of = |cause: u64| {
                let first = number as u64 * 8;
                (first.max(1)..(first + 8).min(5001)).filter(|line| line % 2 == cause).sum::<u64>()
            };
            assert_eq!(group, &[of(0), of(1)], "group {number}");
        }
    }
}
