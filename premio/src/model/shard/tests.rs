use super::*;

#[test]
fn shards_share_the_setups_without_rest() {
    for (count, of) in [(10, 3), (3, 10), (1000, 7), (0, 2)] {
        let head = |index| ShardHead {
            shard: [index, of],
            count,
            ..head()
        };
        let all: Vec<usize> = (1..=of).flat_map(|i| head(i).range()).collect();
        assert_eq!(all, (0..count).collect::<Vec<_>>());
    }
}

fn head() -> ShardHead {
    ShardHead {
        schema: SCHEMA.to_owned(),
        description: DescriptionRecord::default(),
        part: String::new(),
        digest: String::new(),
        setups: String::new(),
        shard: [1, 1],
        count: 0,
    }
}

#[cfg(unix)]
#[test]
fn a_shard_is_as_readable_as_any_other_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let [shard, other] = ["a.shard", "other"].map(|name| folder.path().join(name));
    ShardWriter::new(&shard, &head()).unwrap().finish().unwrap();
    std::fs::write(&other, "").unwrap();
    let [a, b] = [&shard, &other].map(|path| std::fs::metadata(path).unwrap().permissions());
    assert_eq!(a.mode(), b.mode());
}

#[test]
fn a_folder_is_no_place_for_a_shard() {
    let folder = tempfile::tempdir().unwrap();
    assert!(ShardWriter::new(folder.path(), &head()).is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn digests_tell_where_texts_end() {
    let [a, b] = [["ab", "c"], ["a", "bc"]].map(|texts| digest(texts.map(str::as_bytes)));
    assert_ne!(a, b);
}
