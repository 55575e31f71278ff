"""What ``harness check`` can find: every code with its severity and why it bites, and one finding of it."""

from __future__ import annotations

from dataclasses import dataclass

#: from the worst on; only errors make the exit code 1, warnings do so with --strict
SEVERITIES = ("error", "warning", "note")


@dataclass(frozen=True)
class Rule:
    """A kind of finding: ``title`` in a line, ``why`` it bites whom."""

    severity: str
    title: str
    why: str


_E, _W, _N = SEVERITIES

#: code -> rule. HS0 the .sprj, HS1 shaders, HS2 uniforms, HS3 samplers, HS4 textures, HS5 models, HS6 features.
#: Codes are stable: one that is no longer found is not given to anything else.
RULES: dict[str, Rule] = {
    "HS001": Rule(
        _E, "the project cannot be read", "SHADERed only logs this, and shows its start-up template or a black picture."
    ),
    "HS002": Rule(
        _E,
        "a name is taken already",
        "Names of passes and items must differ in more than case, in the whole project; SHADERed drops the second.",
    ),
    "HS003": Rule(_E, "a render texture does not exist", "SHADERed crashes."),
    "HS004": Rule(
        _E, "SHADERed crashes on this", "It does not check what it reads, and the program ends or goes wild."
    ),
    "HS005": Rule(
        _E, "an input layout value does not exist", "SHADERed takes Position for it, and the shader reads positions."
    ),
    "HS006": Rule(
        _W, "something in the project refers to nothing", "SHADERed leaves it out without a word: it has no effect."
    ),
    "HS007": Rule(_W, "SHADERed passes over this in silence", "What it shows is not what the project says."),
    "HS008": Rule(
        _W,
        "harness render cannot draw the project",
        "SHADERed may well; but pictures and tests of it are not to be had.",
    ),
    "HS009": Rule(
        _W,
        "a path leads out of the project's folder",
        "The file is missing wherever the folder is copied or handed in.",
    ),
    "HS010": Rule(
        _W,
        "a pass ends with depth writes off",
        "SHADERed's next depth clear is masked: from frame 2 on the preview shows nothing new. --render does "
        "not show it.",
    ),
    "HS011": Rule(_W, "the camera is not what is written", "SHADERed clamps or guesses it without a word."),
    "HS101": Rule(
        _E,
        "a pass lacks a shader, or its file",
        "SHADERed skips the pass and its clearing; --render still exits with 0.",
    ),
    "HS102": Rule(
        _E,
        "#version is not as it must be on line 1",
        "SHADERed inserts macros behind the first line that holds these letters; above #version the driver "
        "refuses them.",
    ),
    "HS103": Rule(
        _E, "glslang refuses the shader", "SHADERed checks every shader by glslang first, and skips the pass."
    ),
    "HS104": Rule(
        _E,
        "the driver refuses the shader",
        "The text that glslang checked is not what draws: the driver gets the original.",
    ),
    "HS105": Rule(_E, "the stages do not link", "SHADERed never looks at the link status: nothing is drawn."),
    "HS106": Rule(
        _E,
        "a stage reads what the one before does not write",
        "Mesa links it and the value is undefined; other drivers refuse it, and nothing is drawn.",
    ),
    "HS107": Rule(_E, "an included file does not exist", "One compiler fails, the other silently loses the line."),
    "HS108": Rule(
        _E,
        "the two compilers find different files for an include",
        "glslang also looks beside the shader and in another order; the driver's text is pasted from the "
        "include paths, "
        "then the project's folder. What is checked is not what draws.",
    ),
    "HS109": Rule(
        _E,
        "one of the two compilers does not take this form of #include",
        "glslang wants an #extension line, the paste for the driver wants #include in column 0.",
    ),
    "HS110": Rule(
        _N,
        "the #extension line of includes is not guarded",
        "Drivers that do not know GL_GOOGLE_include_directive warn of it at each compilation.",
    ),
    "HS111": Rule(_E, "the entry is not main", "GLSL has no other: the stage links to nothing, and nothing is drawn."),
    "HS112": Rule(
        _W,
        "the shader is not plain GLSL by its extension",
        "SHADERed takes it for HLSL or Vulkan GLSL; it is not checked.",
    ),
    "HS113": Rule(
        _E,
        "a loop never ends",
        "On a GPU the draw hangs until the driver is reset: it runs out of time. llvmpipe leaves the loop after 65535 "
        "rounds with a wrong picture.",
    ),
    "HS201": Rule(
        _E, "a variable does not have its uniform's type", "GL refuses the value in silence, and the uniform stays 0."
    ),
    "HS202": Rule(
        _W,
        "a uniform has no variable",
        "It is 0 in --render; the editor makes a variable for it and guesses a system value from its name.",
    ),
    "HS203": Rule(
        _W, "a variable has no uniform", "It does nothing, and the editor deletes it when the project is saved."
    ),
    "HS204": Rule(_N, "a variable's uniform is declared but not used", "It has no effect on the picture in this pass."),
    "HS205": Rule(
        _W,
        "a system value or function does not fit the variable",
        "SHADERed ignores the attribute in silence: the variable is a constant, 0 without rows.",
    ),
    "HS206": Rule(
        _W,
        "a uniform has an initialiser",
        "It holds in --render, but the editor sets the uniform to 0 without a variable.",
    ),
    "HS207": Rule(_W, "two variables of one name", "The later wins; the first does nothing."),
    "HS208": Rule(
        _W,
        "elements of a uniform array cannot be set",
        "SHADERed sets element 0 of a plain array alone: the others stay 0.",
    ),
    "HS209": Rule(_W, "a uniform block cannot be filled", "A project has no way to give it values: all are undefined."),
    "HS210": Rule(_W, "a value of an item has no effect", "SHADERed leaves it out without a word."),
    "HS211": Rule(_W, "a value is not read as it is written", "SHADERed takes what it can and 0 for the rest."),
    "HS212": Rule(
        _W,
        "a constant matrix is inverted at each draw",
        "SHADERed inverts it in place: every second item gets the matrix itself.",
    ),
    "HS301": Rule(
        _W,
        "text that declares no sampler takes a texture",
        "SHADERed searches the bare text, line by line, for sampler... name; also in comments, under a false #if and "
        "among parameters. All later textures move by one.",
    ),
    "HS302": Rule(_E, "a sampler gets no texture", "It reads unit 0: another texture of the pass, or black."),
    "HS303": Rule(_W, "a texture goes to no sampler", "It is bound to a unit that nothing reads."),
    "HS304": Rule(
        _E,
        "SHADERed's search does not find a sampler's declaration",
        "It wants one declaration a line: uniform sampler2D name; with single spaces. The texture goes to "
        "another name.",
    ),
    "HS305": Rule(
        _W,
        "a sampler stands in another stage than the pixel shader",
        "SHADERed looks for samplers in the pixel shader alone: this one reads unit 0.",
    ),
    "HS306": Rule(
        _W,
        "a texture goes to a sampler with another role",
        "Textures go to samplers by the order of their slots and declarations; names do not matter to SHADERed.",
    ),
    "HS307": Rule(
        _W, "a slot or an object is given twice", "Of two in a slot the last holds; a second object is merged."
    ),
    "HS308": Rule(_E, "a texture is not of its sampler's kind", "The sampler reads black."),
    "HS401": Rule(
        _E, "a texture file does not exist", "SHADERed logs it, and the pass's later textures move up into its slot."
    ),
    "HS402": Rule(
        _E, "a texture file cannot be read", "SHADERed logs it, and the sampler reads black or another texture."
    ),
    "HS403": Rule(
        _W,
        "a texture is upside down for what it is on",
        "SHADERed loads the bottom row first; texture coordinates of model files count from the top.",
    ),
    "HS404": Rule(
        _W,
        "colours are never decoded from sRGB",
        "SHADERed converts nothing: light computed with stored values is too bright in the middle tones.",
    ),
    "HS405": Rule(
        _W,
        "data are decoded as if they were colours",
        "Roughness, metalness and normals are stored linear: decoding bends them.",
    ),
    "HS406": Rule(_W, "colours are decoded from sRGB twice", "The picture is far too dark and too saturated."),
    "HS407": Rule(
        _W,
        "the normal map's green does not point as the shader takes it",
        "DX maps count green down the image, GL maps up: bumps look like dents.",
    ),
    "HS501": Rule(_E, "a model file does not exist or cannot be read", "SHADERed crashes at the first draw."),
    "HS502": Rule(
        _W,
        "a model lacks what the shader reads",
        "SHADERed generates nothing: missing normals, tangents and texture coordinates are 0, and normalize() "
        "of 0 is NaN.",
    ),
    "HS503": Rule(
        _W,
        "tangents point against growing u under a normal map",
        "SHADERed turns the tangents of its own shapes wherever the texture is mirrored: bumps look like dents there.",
    ),
    "HS504": Rule(
        _E,
        "an attribute is beyond the input layout",
        "Nothing is bound to its location: it reads the constant 0, 0, 0, 1.",
    ),
    "HS505": Rule(
        _W,
        "an attribute's name and its place in the input layout disagree",
        "Attribute location k reads the layout's k-th item; names do not matter to SHADERed.",
    ),
    "HS506": Rule(
        _W,
        "a model has different layouts in different passes",
        "SHADERed sets up a model file once: the layout of the last pass holds for all.",
    ),
    "HS507": Rule(
        _W,
        "an attribute has no explicit location",
        "The driver chooses one; another driver, or version, chooses another.",
    ),
    "HS508": Rule(
        _W,
        "a model has mirrored texture coordinates and the pass does not look at handedness",
        "Where the texture is mirrored the bitangent is -cross(n, t): bumps look like dents there.",
    ),
    "HS601": Rule(_W, "a map is the same everywhere", "The pass samples a texture for every pixel to read a constant."),
    "HS602": Rule(
        _W,
        "METALNESS could be fixed",
        "The metalness map says the same everywhere: the pass computes both kinds of material.",
    ),
    "HS603": Rule(_W, "a feature is compiled that nothing needs", "It costs time for every pixel and changes none."),
    "HS604": Rule(
        _W, "a macro is not mentioned in the pass's shaders", "It does nothing; a misspelt name looks the same."
    ),
}


@dataclass(frozen=True)
class Finding:
    """Something found: what, in which file and line, and how to mend it. ``severity`` is the rule's unless the case
    is milder."""

    code: str
    message: str
    fix: str
    file: str
    line: int | None = None
    own_severity: str | None = None

    @property
    def rule(self) -> Rule:
        """What all findings of this code have in common."""
        return RULES[self.code]

    @property
    def severity(self) -> str:
        """One of SEVERITIES."""
        return self.own_severity or self.rule.severity

    @property
    def why(self) -> str:
        """Why it bites."""
        return self.rule.why
