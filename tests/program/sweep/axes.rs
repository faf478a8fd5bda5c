//! Values of a varied key, as the user writes them.

use tilebind::sweep::{Axis, Value};

fn values(text: &str) -> Vec<Value> {
    text.parse::<Axis>().unwrap().values
}

#[test]
fn ranges_hold_both_ends_and_round_numbers() {
    let depth = values("a.b=0:0.05:11");
    assert_eq!(depth.len(), 11);
    assert_eq!(depth[0], Value::Number(0.0));
    assert_eq!(depth[3], Value::Number(0.015));
    assert_eq!(depth[10], Value::Number(0.05));
    assert_eq!(values("a=2:6:3"), [2, 4, 6].map(Value::Whole));
    assert_eq!(values("a=1:2:3")[1], Value::Number(1.5));
    assert_eq!(values("a=3:9:1"), [Value::Whole(3)]);
    assert_eq!(values("a=1:-1:3")[2], Value::Whole(-1));
    assert_eq!(values("a=-0.01:0.02:4")[1], Value::Number(0.0));
    assert_eq!(values("a=1e-15:2e-15:3")[0], Value::Number(1e-15));
}

#[test]
fn lists_hold_numbers_words_and_quoted_words() {
    let list = values("a=1, 2.5,true,NNNS,\"7\"");
    let seven = Value::Text("7".into());
    let word = Value::Text("NNNS".into());
    let expected = [
        Value::Whole(1),
        Value::Number(2.5),
        Value::Truth(true),
        word,
        seven,
    ];
    assert_eq!(list, expected);
}

#[test]
fn what_is_no_axis_is_refused() {
    for wrong in [
        "a",
        "=1",
        "a..b=1",
        "a=",
        "a=1,,2",
        "a=1:2:0",
        "a=1:x:3",
        "a=1:inf:3",
    ] {
        assert!(wrong.parse::<Axis>().is_err(), "{wrong}");
    }
}

#[test]
fn values_survive_json() {
    for value in values("a=1,2.0,true,x,\"1\"") {
        let text = serde_json::to_string(&value).unwrap();
        assert_eq!(
            serde_json::from_str::<Value>(&text).unwrap(),
            value,
            "{text}"
        );
    }
}
