"""Results whose study or mechanism is replaced by another text: it names other files, needs more than any machine has,
or has very many levels.

text_structures() lists them. FROM_FILE is the study of the result whose texts are replaced.
"""

from hostile_structures import Structure
from poesy_program import GALLERY

FROM_FILE = f"""\
format = "poesy-study"
version = 1
mechanism = {{ file = "{GALLERY / "3-rrr/3-rrr.toml"}" }}
poses = {{ count = 3 }}
analysis = {{ samples = 10 }}
"""
OUTSIDE = ["fifo.h5", "/etc/passwd", "/dev/zero", "secret.txt", "secret.h5", "../../../../etc/passwd", "r.h5", "absent"]
DEEP = 20000  # nesting levels
MANY = 1 << 20  # bytes


def text_change(path, change):
    """What a dataset's text becomes; the dataset itself stays."""
    def changed(file, _):
        text = file[path].asstr()[()]
        new = change(text)
        assert new != text, "nothing is changed"
        file[path][()] = new
    return changed


def instead(old, new):
    """A text with a part replaced, once."""
    def change(text):
        assert text.count(old) == 1, f"{old!r} is there {text.count(old)} times"
        return text.replace(old, new)
    return change


def section_instead(title, new):
    """A text with another section in a section's place, up to the next."""
    def change(text):
        begin = text.index(f"[{title}]\n")
        return text[:begin] + new + text[text.index("\n[", begin) + 1:]
    return change


def before(new):
    return lambda text: new + text


def after(new):
    return lambda text: text + "\n" + new


def whole(new):
    return lambda _: new


def lines(make):
    """Numbered lines, a mebibyte of them."""
    count = MANY // len(make(10000))
    return "".join(make(k) for k in range(count))


# Texts that must not harm any reader of TOML
ANY_TEXT = {
    "empty": whole(""),
    "no TOML": whole("daemon:x:1:1\n" * 1000),
    "a mebibyte of settings": after("[other]\n" + lines(lambda k: f"setting_{k} = {k}\n")),
    "a mebibyte of sections": after(lines(lambda k: f"[section_{k}]\n")),
    "a mebibyte of elements of a list": after("[other]\nlist = [" + "1," * (MANY // 2) + "]\n"),
    "a mebibyte in one name": before("n" * MANY + " = 1\n"),
    "a mebibyte in one text": before('note = "' + "x" * MANY + '"\n'),
    "a mebibyte without a line's end": before("# " + "x" * MANY + "\n"),
    "a mebibyte of line ends": before("\n" * MANY),
    "nested lists": before("deep = " + "[" * DEEP + "]" * DEEP + "\n"),
    "nested lists that do not end": before("deep = " + "[" * DEEP + "\n"),
    "nested tables": before("deep = " + "{ a = " * DEEP + "1" + " }" * DEEP + "\n"),
    "a name of many parts": before(".".join("a" * DEEP) + " = 1\n"),
    "a section of many parts": after("[" + ".".join("a" * DEEP) + "]\n"),
    "escapes": before('"\\u001b[2J" = "\\u0000\\u202e"\n'),
}


def study_texts():
    poses = [(f"poses from {name}", section_instead("poses", f'[poses]\nfile = "{name}"\n\n')) for name in OUTSIDE]
    curve = '[poses]\nselect = "trajectory"\ntrajectory = {{ file = "{}" }}\n\n'
    trajectories = [(f"trajectory from {name}", section_instead("poses", curve.format(name))) for name in OUTSIDE]
    measured = [(f"{words}errors measured in {name}", instead("\n[analysis]\n", f"""{line}
[errors.override]
delta_1_0_x = {{ distribution = "measured", file = "{name}", column = "x" }}
delta_1_0_y = {{ distribution = "measured", file = "{name}", column = "y" }}

[analysis]
""")) for words, line in (("", ""), ("correlated ", 'correlated = "as measured"\n')) for name in OUTSIDE]
    own = f'file = "{GALLERY / "3-rrr/3-rrr.toml"}"'
    mechanisms = [(f"mechanism from {name}", instead(own, f'file = "{name}"')) for name in OUTSIDE]
    most = (1 << 63) - 1
    return [
        *ANY_TEXT.items(), *poses, *trajectories, *measured, *mechanisms,
        ("another mechanism", instead(own, 'model = "2upr-rpu"')),
        ("mechanism from many folders", instead(own, 'file = "' + "../" * 100000 + '"')),
        ("the most poses", instead("count = 3", f"count = {most}")),
        ("a billion poses", instead("count = 3", "count = 1000000000")),
        ("the most samples", instead("samples = 10", f"samples = {most}")),
        ("a billion samples", instead("samples = 10", "samples = 1000000000")),
        ("the most iterations", instead("max_iterations = 50", f"max_iterations = {most}")),
        ("a million errors", instead('factors = "all"', "factors = [" + '"delta_1_0_x", ' * (MANY // 16) + "]")),
        ("a pattern of many stars", instead('factors = "all"', 'factors = ["' + "*_" * 200 + '"]')),
        ("no pose", instead('x = ["-0.04 m", "0.04 m"]', 'x = ["1e300 m", "1e301 m"]')),
    ]


def mechanism_texts():
    copies = "copies = { count = 3,"
    joint = '  { name = "B", type = "R", at = "elbow", axis = "z" },\n'
    radius = 'a = { value = "300 mm"'
    sets = '[sets]\n'

    def joints(count, kind="R"):
        return "".join(f'  {{ name = "J{k}", type = "{kind}", at = ["{k + 1} mm", 0, 0], axis = "z" }},\n' for k in range(count))

    def limb(text):
        begin = text.index("[[limb]]")
        return text[begin:text.index("[errors]")]

    return [
        *ANY_TEXT.items(),
        ("100 copies", instead(copies, "copies = { count = 100,")),
        ("a billion copies", instead(copies, "copies = { count = 1000000000,")),
        ("400 joints", instead(joint, joints(400))),
        ("100 copies of 40 joints", lambda text: instead(joint, joints(40))(instead(copies, "copies = { count = 100,")(text))),
        ("4000 joints", instead(joint, joints(4000))),
        ("400 joints that do not move", instead(joint, joint + joints(400, "fixed"))),
        ("20000 joints that do not move", instead(joint, joint + joints(20000, "fixed"))),
        ("1000 limbs", lambda text: text.replace("[errors]", limb(text) * 1000 + "[errors]")),
        ("a limb of no joint", section_instead("[limb]", "[[limb]]\njoints = []\n\n")),
        ("nested brackets in a formula", instead('["a", 0, 0]', '["' + "(" * DEEP + "a" + ")" * DEEP + '", 0, 0]')),
        ("many signs in a formula", instead('["a", 0, 0]', '["' + "-" * DEEP + 'a", 0, 0]')),
        ("many terms in a formula", instead('["a", 0, 0]', '["a' + " + 0 * a" * (MANY // 8) + '", 0, 0]')),
        ("a formula that overflows", instead('["a", 0, 0]', '["a' + " * 1e300" * 100 + '", 0, 0]')),
        ("a formula that divides by nothing", instead('["a", 0, 0]', '["a / (a - a)", 0, 0]')),
        ("a size of 1e300", instead(radius, 'a = { value = "1e300 m"')),
        ("a size of nothing", instead(radius, 'a = { value = "0 mm"')),
        ("20000 sizes", instead("[geometry]\n", "[geometry]\n" + "".join(f'g{k} = "{k + 1} mm"\n' for k in range(20000)))),
        ("20000 points", instead("[points]\n", "[points]\n" + "".join(f'p{k} = ["{k} mm", 0, 0]\n' for k in range(20000)))),
        ("20000 sets", instead(sets, sets + "".join(f's{k} = ["delta_*"]\n' for k in range(20000)))),
        ("a set of many patterns", instead(sets, sets + "many = [" + '"*_*_*", ' * (MANY // 9) + "]\n")),
        ("a set of many stars", instead(sets, sets + 'stars = ["' + "*_" * 200 + 'q"]\n')),
        ("files for points", instead('elbow = ["220 mm", "120 mm", 0]', 'elbow = { file = "fifo.h5" }')),
        ("a long title", instead("planar 3-RRR", "x" * MANY)),
    ]


def text_structures():
    """All of them; their names are unique."""
    found = [Structure(f"{which}: {name}", "text", text_change(f"{which}/text", change))
             for which, texts in (("study", study_texts()), ("mechanism", mechanism_texts())) for name, change in texts]
    assert len({one.name for one in found}) == len(found)
    return found
