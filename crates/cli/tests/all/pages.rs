//! What the command line prints, page by page. Look at changes, then accept them: TRYCMD=overwrite cargo test -p kempe-cli.

#[test]
fn pages() {
    trycmd::TestCases::new().case("tests/cmd/*.trycmd");
}
