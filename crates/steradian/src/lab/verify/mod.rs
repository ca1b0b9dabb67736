//! Whether materials obey the laws that light transport relies on: the conformance suite over the built-in specimens or a
//! scene's own materials.

mod html;
mod report;

pub use html::html;
pub use report::{
    Acceptance, AlbedoAt, Brightest, Inspection, Origin, Report, Standing, SubjectReport, Verdict, WorstPair,
    degrees,
};

use super::subject::Subject;
use crate::bsdf::conformance::{Effort, examine};
use crate::bsdf::{Bsdf, Cabinet, Specimen};
use crate::math::{LocalDir, Vec2, warp};
use crate::spectrum::{LANES, Wavelengths};
use rayon::prelude::*;

/// How to verify.
#[derive(Clone, Debug)]
pub struct Options {
    /// How thoroughly, and how sure.
    pub effort: Effort,
    /// Wavelengths [nm] that a scene's materials are examined at, at least one; [`DEFAULT_WAVELENGTHS`] if in doubt.
    pub wavelengths: Vec<f32>,
    /// Number of threads; all cores where `None`. The report does not depend on it.
    pub threads: Option<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self { effort: Effort::NORMAL, wavelengths: DEFAULT_WAVELENGTHS.to_vec(), threads: None }
    }
}

/// Wavelengths of an examination where none are asked for [nm].
pub const DEFAULT_WAVELENGTHS: [f32; LANES] = [440.0, 520.0, 600.0, 680.0];

/// Where ρ(λ) is taken [nm].
const SPECTRUM: std::ops::Range<u16> = 380..784;
/// Distance of its wavelengths [nm].
const SPECTRUM_STEP: usize = 20;
/// Angles of incidence of ρ(λ) [°].
const SPECTRUM_ANGLES: [f32; 2] = [0.0, 60.0];
/// Where a textured material is looked at.
const PLACES: [Vec2; 3] = [Vec2::new(0.5, 0.5), Vec2::new(0.13, 0.27), Vec2::new(0.79, 0.61)];

/// Called after each subject with the number of those done and of all.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Verifies all built-in specimens.
pub fn specimens(options: &Options, progress: Progress<'_>) -> Report {
    let cabinet = Cabinet::default();
    let specimens = Bsdf::specimens(&cabinet);
    let effort = options.effort.among(specimens.len());
    run(options, &specimens, progress, |specimen| specimen_report(specimen, &effort))
}

/// Verifies materials of a scene; of a mix, which is none itself, say so.
pub fn subjects(subjects: &[Subject<'_>], options: &Options, progress: Progress<'_>) -> Report {
    let effort = options.effort.among(subjects.len() * PLACES.len() * options.wavelengths.len());
    run(options, subjects, progress, |subject| subject_report(subject, options, &effort))
}

fn run<T: Sync>(
    options: &Options,
    items: &[T],
    progress: Progress<'_>,
    examine: impl Fn(&T) -> SubjectReport + Sync,
) -> Report {
    let done = std::sync::atomic::AtomicUsize::new(0);
    let all = || -> Vec<SubjectReport> {
        items
            .par_iter()
            // Subjects differ in cost by an order of magnitude.
            .with_max_len(1)
            .map(|item| {
                let report = examine(item);
                progress(1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed), items.len());
                report
            })
            .collect()
    };
    let pool = options.threads.map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build());
    let subjects = match pool {
        Some(Ok(pool)) => pool.install(all),
        // Without threads of its own the run takes the common ones: the report is the same.
        Some(Err(_)) | None => all(),
    };
    Report { subjects, seed: options.effort.seed, level: options.effort.level }
}

fn specimen_report(specimen: &Specimen<Bsdf<'_>>, effort: &Effort) -> SubjectReport {
    let inspection = Inspection { uv: [0.5; 2], wavelengths: None, examination: examine(specimen, effort) };
    SubjectReport {
        name: specimen.name.to_owned(),
        origin: Origin::Specimen,
        note: None,
        claims: Some(specimen.claims),
        inspections: vec![inspection],
        over_angle: over_angle(&specimen.bsdf, None),
        over_wavelength: Vec::new(),
    }
}

fn subject_report(subject: &Subject<'_>, options: &Options, effort: &Effort) -> SubjectReport {
    let mut report = SubjectReport {
        name: subject.name().to_owned(),
        origin: Origin::Material,
        note: None,
        claims: None,
        inspections: Vec::new(),
        over_angle: Vec::new(),
        over_wavelength: Vec::new(),
    };
    let parts: Vec<&str> = subject.parts().iter().map(Subject::name).collect();
    if !parts.is_empty() {
        report.note = Some(format!("a mix, verified through its parts: {}", parts.join(", ")));
        return report;
    }
    let places = if subject.is_textured() { &PLACES[..] } else { &PLACES[..1] };
    let mut notes: Vec<&str> = Vec::new();
    for &uv in places {
        let subject = subject.at_uv(uv);
        for lambda in batches(&subject, &options.wavelengths) {
            let Some(bsdf) = subject.scatterer(&mut Wavelengths::exactly(lambda), effort.seed) else {
                report.note = Some("a mere boundary of media: it does not scatter".to_owned());
                return report;
            };
            let claims = bsdf.claims();
            report.claims = Some(claims);
            let examination = examine(&Specimen::new("", claims, bsdf), effort);
            report.inspections.push(Inspection { uv: uv.to_array(), wavelengths: Some(lambda), examination });
            if report.over_angle.is_empty() {
                report.over_angle = over_angle(&bsdf, Some(lambda));
            }
        }
    }
    if places.len() > 1 {
        notes.push("textured: examined at three places");
    }
    if report.claims.is_some_and(|c| c.has_named_bias()) {
        notes.push("its values have a named bias, for pictures that equal another renderer's");
    }
    if report.reports_reciprocity() {
        notes.push("it does not claim reciprocity: the worst pair is reported and not judged");
    }
    report.note = (!notes.is_empty()).then(|| notes.join("; "));
    report.over_wavelength = over_wavelength(subject, effort.seed);
    report
}

/// The wavelengths in groups that one function carries; one by one where directions depend on the wavelength.
fn batches(subject: &Subject<'_>, wavelengths: &[f32]) -> Vec<[f32; LANES]> {
    let mut probe = Wavelengths::exactly(lanes(wavelengths));
    let _ = subject.scatterer(&mut probe, 0);
    let size = if probe.companions_terminated() { 1 } else { LANES };
    wavelengths.chunks(size).map(lanes).collect()
}

/// Fills the lanes, the last wavelength again where there are fewer.
fn lanes(wavelengths: &[f32]) -> [f32; LANES] {
    let last = wavelengths.last().copied().unwrap_or(DEFAULT_WAVELENGTHS[0]);
    std::array::from_fn(|lane| wavelengths.get(lane).copied().unwrap_or(last))
}

fn over_angle(bsdf: &Bsdf<'_>, wavelengths: Option<[f32; LANES]>) -> Vec<AlbedoAt> {
    let above = (0..18).map(|i| 5.0 * i as f32).chain([89.0]);
    let below = (0..18).map(|i| 180.0 - 5.0 * i as f32).chain([91.0]);
    above.chain(below).map(|theta| albedo_at(bsdf, theta, wavelengths)).collect()
}

fn over_wavelength(subject: &Subject<'_>, seed: u64) -> Vec<AlbedoAt> {
    let spectrum: Vec<f32> = SPECTRUM.step_by(SPECTRUM_STEP).map(f32::from).collect();
    let mut curve = Vec::new();
    for lambda in batches(subject, &spectrum) {
        let Some(bsdf) = subject.scatterer(&mut Wavelengths::exactly(lambda), seed) else { continue };
        curve.extend(SPECTRUM_ANGLES.iter().map(|&theta| albedo_at(&bsdf, theta, Some(lambda))));
    }
    curve
}

fn albedo_at(bsdf: &Bsdf<'_>, theta: f32, wavelengths: Option<[f32; LANES]>) -> AlbedoAt {
    let wi = LocalDir::new_unchecked(warp::spherical_direction(theta.to_radians(), 0.7));
    AlbedoAt { theta: f64::from(theta), wavelengths, albedo: bsdf.albedo(wi) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::conformance::Law;
    use crate::scene::import::pbrt::{Input, import};
    use crate::scene::{MemoryFiles, RenderJob, compile};
    use std::path::Path;

    fn job(materials: &str) -> RenderJob {
        let files = MemoryFiles::default();
        let text = format!("WorldBegin {materials}");
        let input = Input::Text { name: "test", bytes: text.as_bytes(), base: Path::new("") };
        let mut imported = import(&[input], &files);
        let desc = imported.scene.take().expect("a scene");
        compile(desc, &files, &mut imported.diagnostics).expect("compiles")
    }

    fn verified(materials: &str, options: &Options) -> Report {
        let job = job(materials);
        subjects(&Subject::all(&job)[1..], options, &|_, _| {})
    }

    fn quick() -> Options {
        Options { effort: Effort { samples: 1 << 13, ..Effort::QUICK }, ..Options::default() }
    }

    #[test]
    fn verdicts_follow_the_laws_and_the_claims() {
        let report = verified(
            "MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"rgb reflectance\" [0.5 0.2 0.1] \
             MakeNamedMaterial \"printed\" \"string type\" \"modifiedphong\" \"spectrum diffuse\" [400 0 700 0] \
             \"spectrum specular\" [400 1 700 1] \"float exponent\" 10 \"string lobe\" \"halfway\" \
             \"string normalization\" \"printed\" \
             MakeNamedMaterial \"legacy\" \"string type\" \"phong\" \
             MakeNamedMaterial \"coated\" \"string type\" \"coateddiffuse\" \"float roughness\" 0.5 \
             MakeNamedMaterial \"blend\" \"string type\" \"mix\" \"string materials\" [\"paint\" \"coated\"] \
             Material \"interface\"",
            &quick(),
        );
        let [paint, printed, legacy, coated, blend, boundary] = &report.subjects[..] else {
            panic!("six subjects")
        };
        assert_eq!(paint.verdict(), Verdict::Lawful);
        // B (2.35) to the letter returns 2.866 times the light at normal incidence for n = 10.
        assert_eq!(printed.verdict(), Verdict::Contradicted);
        assert_eq!(printed.standing(Law::Energy), Some(Standing::Contradicted));
        let brightest = printed.brightest().unwrap();
        assert!((brightest.value - 2.866).abs() < 5e-3, "{brightest:?}");
        assert_eq!(legacy.verdict(), Verdict::BrokenAsDeclared);
        assert_eq!(legacy.standing(Law::Reciprocity), Some(Standing::BrokenAsDeclared));
        // It may return more light than arrives; whether it does is a matter of its parameters.
        assert_ne!(legacy.standing(Law::Energy), Some(Standing::Contradicted));
        assert!(legacy.worst_pair().unwrap().relative() > 0.1);
        assert_eq!(coated.verdict(), Verdict::BrokenAsDeclared, "{coated:?}");
        assert_eq!(blend.verdict(), Verdict::NotExamined);
        assert_eq!(boundary.verdict(), Verdict::NotExamined);
        assert!(!report.passes(Acceptance::AsDeclared) && !printed.passes(Acceptance::AsDeclared));
        assert!(legacy.passes(Acceptance::AsDeclared) && !legacy.passes(Acceptance::Lawful));
        let page = html(&report, "a < b");
        assert!(page.contains("a &lt; b") && page.matches("<svg").count() == 8, "{page}");
    }

    #[test]
    fn report_does_not_depend_on_the_number_of_threads() {
        let report = |threads| {
            let options = Options { threads: Some(threads), ..quick() };
            verified(
                "MakeNamedMaterial \"a\" \"string type\" \"coateddiffuse\" \
                 MakeNamedMaterial \"b\" \"string type\" \"conductor\" \"float roughness\" 0.3",
                &options,
            )
        };
        assert_eq!(report(1), report(2));
    }

    #[test]
    fn dispersive_materials_are_examined_wavelength_by_wavelength() {
        let options = Options { wavelengths: vec![450.0, 650.0], ..quick() };
        let report = verified(
            "MakeNamedMaterial \"prism\" \"string type\" \"dielectric\" \"spectrum eta\" \"glass-F11\"",
            &options,
        );
        let [prism] = &report.subjects[..] else { panic!("one subject") };
        let wavelengths: Vec<_> = prism.inspections.iter().map(|i| i.wavelengths.unwrap()[0]).collect();
        assert_eq!(wavelengths, [450.0, 650.0]);
        assert_eq!(prism.verdict(), Verdict::Lawful);
        // Fresnel at normal incidence, for either index.
        let mirror = |i: usize| prism.inspections[i].examination.powers[0].own.reflectance[0];
        assert!(mirror(0) > mirror(1) + 1e-4, "{} {}", mirror(0), mirror(1));
    }
}
