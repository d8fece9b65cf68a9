//! Memory that the control groups of this process leave it, of either version. A limit holds for a group and all groups within it, so every group on the
//! way up to the root counts.

use std::path::{Component, Path, PathBuf};

/// The kernel's files that say which groups a process is in, and where their files are.
const GROUPS: &str = "proc/self/cgroup";
const MOUNTS: &str = "proc/self/mountinfo";

/// Names of the files of a version.
struct Names {
    /// Limits, of which the lowest counts.
    limits: &'static [&'static str],
    used: &'static str,
    /// The row of `memory.stat` that tells how much of what is used the kernel gives back when it is asked for: files that nobody has looked at lately.
    reclaimable: &'static str,
}

const VERSION_2: Names = Names { limits: &["memory.max", "memory.high"], used: "memory.current", reclaimable: "inactive_file" };
const VERSION_1: Names =
    Names { limits: &["memory.limit_in_bytes"], used: "memory.usage_in_bytes", reclaimable: "total_inactive_file" };

/// Bytes that the groups leave to this process; None where none sets a limit. `root`: of the file system.
pub fn left(root: &Path) -> Option<u64> {
    let groups = std::fs::read_to_string(root.join(GROUPS)).ok()?;
    let mounts = std::fs::read_to_string(root.join(MOUNTS)).ok()?;
    let mounts: Vec<Mount> = mounts.lines().filter_map(Mount::parse).collect();
    groups.lines().filter_map(|line| left_by(root, line, &mounts)).min()
}

/// By a row of the process's groups: the number of a hierarchy, what it controls, and the group. Version 2 has the number 0 and says nothing of what it
/// controls.
fn left_by(root: &Path, line: &str, mounts: &[Mount]) -> Option<u64> {
    let (number, rest) = line.split_once(':')?;
    let (controllers, group) = rest.split_once(':')?;
    let is_second = number == "0" && controllers.is_empty();
    if !is_second && !controllers.split(',').any(|controller| controller == "memory") {
        return None;
    }
    let names = if is_second { &VERSION_2 } else { &VERSION_1 };
    let of_version = mounts.iter().filter(|mount| mount.is_of(is_second));
    of_version.filter_map(|mount| mount.folders(Path::new(group)).filter_map(|folder| left_in(root, &folder, names)).min()).min()
}

/// The memory that one group leaves.
fn left_in(root: &Path, folder: &Path, names: &Names) -> Option<u64> {
    let folder = root.join(folder.strip_prefix("/").unwrap_or(folder));
    let text = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
    let number = |name: &str| text(name)?.trim().parse::<u64>().ok();
    // Without a limit, the file says `max`, or a number beyond all memory.
    let limit = names.limits.iter().filter_map(|name| number(name)).min()?;
    let used = number(names.used)?;
    let row = |text: String| {
        let value = text.lines().find_map(|line| line.strip_prefix(names.reclaimable)?.strip_prefix(' ')?.trim().parse().ok());
        value.unwrap_or(0)
    };
    let reclaimable = text("memory.stat").map_or(0, row);
    Some(limit.saturating_sub(used.saturating_sub(reclaimable)))
}

/// The folder at which a hierarchy of groups is mounted.
struct Mount {
    /// The group that stands at the place.
    group: PathBuf,
    place: PathBuf,
    kind: String,
    options: String,
}

impl Mount {
    /// From a row of the kernel's table: fields, of which the fourth and fifth count, up to a lone hyphen, then the file system, its source and its options.
    fn parse(line: &str) -> Option<Self> {
        let (fields, system) = line.split_once(" - ")?;
        let mut fields = fields.split(' ').skip(3);
        let (group, place) = (unescaped(fields.next()?), unescaped(fields.next()?));
        let mut system = system.split(' ');
        let (kind, _, options) = (system.next()?, system.next()?, system.next()?);
        Some(Self { group, place, kind: kind.to_owned(), options: options.to_owned() })
    }

    fn is_of(&self, second_version: bool) -> bool {
        match second_version {
            true => self.kind == "cgroup2",
            false => self.kind == "cgroup" && self.options.split(',').any(|option| option == "memory"),
        }
    }

    /// The folders of a group and of all that it is in, from within. In a container the process's group may be told by a name from outside; then the place itself is
    /// that of the container's group.
    fn folders(&self, group: &Path) -> impl Iterator<Item = PathBuf> {
        let goes_up = group.components().any(|component| component == Component::ParentDir);
        let within = group.strip_prefix(&self.group).ok().filter(|_| !goes_up).unwrap_or(Path::new(""));
        within.ancestors().map(|within| self.place.join(within)).collect::<Vec<_>>().into_iter()
    }
}

/// A path with its blanks and backslashes, for which octal numbers stand.
fn unescaped(field: &str) -> PathBuf {
    let named = [("\\040", " "), ("\\011", "\t"), ("\\012", "\n"), ("\\134", "\\")];
    PathBuf::from(named.iter().fold(field.to_owned(), |text, (number, letter)| text.replace(number, letter)))
}

#[cfg(test)]
pub mod tests {
    use std::fs;

    use tempfile::TempDir;

    use super::*;

    /// The files of a made-up system.
    pub struct System(TempDir);

    impl System {
        pub fn new(files: &[(&str, &str)]) -> Self {
            let system = Self(tempfile::tempdir().expect("a temporary folder"));
            files.iter().for_each(|(name, text)| system.write(name, text));
            system
        }

        pub fn root(&self) -> &Path {
            self.0.path()
        }

        pub fn write(&self, name: &str, text: &str) {
            let path = self.0.path().join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            fs::write(path, text).expect("a file");
        }
    }

    const MOUNTS_OF_2: &str = "22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw\n\
        30 22 0:26 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n";
    const MOUNTS_OF_1: &str = "31 22 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n\
        34 31 0:31 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n\
        35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n";

    fn version_2(files: &[(&str, &str)]) -> System {
        let system = System::new(&[(GROUPS, "0::/user.slice/job 1.scope\n"), (MOUNTS, MOUNTS_OF_2)]);
        files.iter().for_each(|(name, text)| system.write(&format!("sys/fs/cgroup/{name}"), text));
        system
    }

    #[test]
    fn the_second_version_limits_its_groups() {
        let own = |name: &str| format!("user.slice/job 1.scope/{name}");
        let [max, high, current, stat] = ["memory.max", "memory.high", "memory.current", "memory.stat"].map(own);
        let system = version_2(&[(&max, "max\n"), (&high, "max\n"), (&current, "400\n")]);
        assert_eq!(left(system.root()), None);
        for (name, text, expected) in [
            (&max, "1000\n", 600),
            // Memory that the kernel gives back when it is asked for it counts as free.
            (&stat, "anon 100\ninactive_file 150\nactive_file 70\n", 750),
            (&high, "900\n", 650),
            // More is used than is allowed.
            (&current, "5000\n", 0),
            // All that is used can be given back.
            (&stat, "inactive_file 9000\n", 900),
        ] {
            system.write(&format!("sys/fs/cgroup/{name}"), text);
            assert_eq!(left(system.root()), Some(expected), "{name}: {text}");
        }
    }

    /// A group within one that has less left has no more.
    #[test]
    fn groups_around_a_group_count() {
        let system = version_2(&[
            ("user.slice/job 1.scope/memory.max", "1000"),
            ("user.slice/job 1.scope/memory.current", "100"),
            ("user.slice/memory.max", "800"),
            ("user.slice/memory.current", "300"),
            ("user.slice/other/memory.max", "1"),
            ("user.slice/other/memory.current", "1"),
        ]);
        assert_eq!(left(system.root()), Some(500));
        system.write("sys/fs/cgroup/memory.max", "400");
        system.write("sys/fs/cgroup/memory.current", "390");
        assert_eq!(left(system.root()), Some(10));
    }

    #[test]
    fn the_first_version_limits_its_groups() {
        let groups = "9:name=systemd:/\n5:cpu,cpuacct:/docker/abc\n4:memory:/docker/abc\n0::/\n";
        let unlimited = "9223372036854771712\n";
        let system = System::new(&[
            (GROUPS, groups),
            (MOUNTS, MOUNTS_OF_1),
            ("sys/fs/cgroup/memory/docker/abc/memory.limit_in_bytes", "2000\n"),
            ("sys/fs/cgroup/memory/docker/abc/memory.usage_in_bytes", "1500\n"),
            ("sys/fs/cgroup/memory/docker/abc/memory.stat", "inactive_file 7\ntotal_inactive_file 500\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", unlimited),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "100000\n"),
            ("sys/fs/cgroup/cpu,cpuacct/docker/abc/memory.limit_in_bytes", "1\n"),
            ("sys/fs/cgroup/cpu,cpuacct/docker/abc/memory.usage_in_bytes", "1\n"),
        ]);
        assert_eq!(left(system.root()), Some(1000));
    }

    /// The group's name is one from outside of the container, in which the hierarchy is mounted from the container's own group on, or is not told.
    #[test]
    fn containers_see_their_own_group() {
        for (group, mounted) in
            [("/docker/abc/inner", "/docker/abc"), ("/docker/abc", "/docker/abc"), ("/../elsewhere", "/"), ("/", "/..")]
        {
            let mounts = format!("30 22 0:26 {mounted} /sys/fs/my\\040groups rw - cgroup2 cgroup2 rw\n");
            let system = System::new(&[
                (GROUPS, &format!("0::{group}\n")),
                (MOUNTS, &mounts),
                ("sys/fs/my groups/memory.max", "70"),
                ("sys/fs/my groups/memory.current", "20"),
            ]);
            assert_eq!(left(system.root()), Some(50), "{group} in {mounted}");
        }
    }

    #[test]
    fn tables_of_other_kinds_say_nothing() {
        for (groups, mounts) in
            [("", ""), ("nonsense\n0:\n", "nonsense - \n1 2\n"), ("0::/a\n", "22 1 8:1 / / rw - ext4 /dev/sda1 rw\n")]
        {
            assert_eq!(left(System::new(&[(GROUPS, groups), (MOUNTS, mounts)]).root()), None);
        }
        assert_eq!(left(Path::new("/no/such/folder")), None);
    }
}
