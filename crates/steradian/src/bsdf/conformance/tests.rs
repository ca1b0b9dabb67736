use super::*;

#[test]
fn every_specimen_obeys_every_law_it_claims() {
    let mut broken = Vec::new();
    for specimen in Bsdf::specimens() {
        for f in examine(&specimen, &Effort::default()) {
            if !f.holds() {
                broken.push(format!(
                    "{}: {:?} at {:?} ({:?}): {:?}",
                    specimen.name, f.law, *f.wo, f.mode, f.evidence
                ));
            }
        }
    }
    assert!(broken.is_empty(), "{} findings:\n{}", broken.len(), broken.join("\n"));
}
