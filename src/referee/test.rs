//! One test of the suite: a scene, the question it asks, and the true picture.

use super::picture::{SceneFile, TruthPicture};
use super::truth::{Formula, FormulaShape, Truth};

/// A scene that asks one thing of a renderer.
pub struct Test {
    /// Family and name, as in `lights/point`.
    pub name: &'static str,
    /// A sentence on what is tested.
    pub about: &'static str,
    /// The clause of a specification, or the law, that decides who is right.
    pub decides: &'static str,
    /// The scene file, whose paths are relative to its own folder.
    pub scene: String,
    /// Pictures and models that it names.
    pub files: Vec<SceneFile>,
    pub truth: Truth,
    /// Mistakes that renderers make here, each with the picture that they lead to.
    pub variants: Vec<Variant>,
}

/// A mistake, and the picture of who makes it.
pub struct Variant {
    /// A noun phrase, as in "an sRGB texture that is read as linear".
    pub cause: &'static str,
    pub picture: VariantPicture,
}

/// How the picture of a mistake is found.
pub enum VariantPicture {
    /// By a formula.
    Formula(Formula),
    /// By the reference, of this scene file in place of the test's.
    Scene(String),
}

impl Test {
    /// A test whose every pixel a formula tells: `value` at a point of the film, of which each coordinate goes from 0 to 1, to the right and down. A pixel
    /// is the mean over its square.
    pub fn of_formula(
        [name, about, decides]: [&'static str; 3],
        scene: String,
        value: impl Fn(f64, f64) -> [f64; 3] + Send + Sync + 'static,
    ) -> Self {
        Self {
            name,
            about,
            decides,
            scene,
            files: Vec::new(),
            truth: Truth::Formula(Formula::smooth(value)),
            variants: Vec::new(),
        }
    }

    /// A test whose picture has one value everywhere.
    pub fn of_constant(texts: [&'static str; 3], scene: String, value: [f64; 3]) -> Self {
        Self::of_formula(texts, scene, move |_, _| value)
    }

    /// A test whose truth was found by long renders of both devices and is shipped.
    pub fn estimated([name, about, decides]: [&'static str; 3], scene: String) -> Self {
        Self { name, about, decides, scene, files: Vec::new(), truth: Truth::Shipped, variants: Vec::new() }
    }

    /// The formula, and those of mistakes that follow, have edges within pixels.
    pub fn with_edges(self) -> Self {
        self.with_shape(FormulaShape::Edges)
    }

    /// The formula, and those of mistakes that follow, have kinks within pixels.
    pub fn with_kinks(self) -> Self {
        self.with_shape(FormulaShape::Kinks)
    }

    fn with_shape(mut self, shape: FormulaShape) -> Self {
        if let Truth::Formula(formula) = &mut self.truth {
            formula.shape = shape;
        }
        self
    }

    /// A picture or model that the scene names.
    pub fn file(mut self, file: SceneFile) -> Self {
        self.files.push(file);
        self
    }

    /// A mistake whose picture is known by a formula, with edges where the truth has them.
    pub fn mistake(mut self, cause: &'static str, value: impl Fn(f64, f64) -> [f64; 3] + Send + Sync + 'static) -> Self {
        let shape = if let Truth::Formula(formula) = &self.truth { formula.shape } else { FormulaShape::Smooth };
        let mut formula = Formula::smooth(value);
        formula.shape = shape;
        self.variants.push(Variant { cause, picture: VariantPicture::Formula(formula) });
        self
    }

    /// A mistake whose picture is that of the scene with these words in place of others.
    ///
    /// # Panics
    /// The scene does not hold `words`.
    pub fn mistake_in_scene(mut self, cause: &'static str, words: &str, others: &str) -> Self {
        assert!(self.scene.contains(words), "{}: {words:?} is not in the scene", self.name);
        let scene = self.scene.replace(words, others);
        self.variants.push(Variant { cause, picture: VariantPicture::Scene(scene) });
        self
    }

    /// The part of the name before the stroke.
    pub fn family(&self) -> &'static str {
        self.name.split_once('/').map_or(self.name, |(family, _)| family)
    }

    /// The name without strokes, for files.
    pub fn file_name(&self) -> String {
        self.name.replace('/', "-")
    }

    /// The true picture.
    ///
    /// # Errors
    /// A sentence: the shipped picture is missing or damaged.
    pub fn true_picture(&self) -> Result<TruthPicture, String> {
        self.truth.picture(&self.file_name(), self.size())
    }

    /// Width and height of the picture.
    ///
    /// # Panics
    /// The scene has no film: a mistake in the suite, which its tests notice.
    pub fn size(&self) -> [u32; 2] {
        let (_, after) = self.scene.split_once("size = [").expect("the film has a size");
        let (numbers, _) = after.split_once(']').expect("a list ends");
        let mut lengths = numbers.split(',').map(|number| number.trim().parse().expect("a length"));
        std::array::from_fn(|_| lengths.next().expect("there are two"))
    }
}
