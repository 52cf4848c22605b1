//! Where the network of an experiment comes from: files, generators, preparation, groups.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::ops::Range;
use std::path::{Path, PathBuf};

use graph::formats::{self, Attributes, Layout, Options, Rows};
use graph::generators::{
    LinkProbability, communities, expected_hierarchical_links, expected_links, hierarchical,
};
use graph::prepare::{Report, Selection, Step, Symmetrise, apply};
use graph::{Group, Network, RawNetwork};

use super::checker::Checker;
use super::watched::Watched;
use crate::spec::{
    AttributesSpec, CommunitiesSpec, FileSpec, GroupsSpec, HierarchicalSpec, NetworkSpec, RowsSpec,
    StepSpec, SymmetriseSpec,
};
use user::files;
use user::text::shown;
use user::{Problem, Result};

impl Checker<'_> {
    /// The network, prepared and grouped, with what each step of preparation did.
    pub(super) fn source(&self) -> Result<(Network, Vec<Report>)> {
        let stages = self.stages;
        let raw = match &self.experiment.network {
            NetworkSpec::File(spec) => self.file(spec)?,
            NetworkSpec::Communities(spec) => {
                stages.unmeasured("generation", || self.communities(spec))?.into()
            }
            NetworkSpec::Hierarchical(spec) => {
                stages.unmeasured("generation", || self.hierarchical(spec))?.into()
            }
        };
        stages.unmeasured("preparation", || self.prepared(raw))
    }

    fn prepared(&self, mut raw: RawNetwork) -> Result<(Network, Vec<Report>)> {
        let mut reports = Vec::new();
        for (number, spec) in self.experiment.prepare.iter().enumerate() {
            let refuse = |message: String| self.problem(&format!("prepare[{number}]"), message);
            let step = step(spec).map_err(refuse)?;
            let (next, report) = apply(&raw, &step)
                .map_err(|error| refuse(format!("cannot be applied: {error}")))?;
            raw = next;
            reports.push(report);
        }
        let is_directed = raw.is_directed();
        let network = raw.into_network().map_err(|error| self.unsupported(is_directed, &error))?;
        Ok((self.grouped(network)?, reports))
    }

    /// What is said of a network that is directed, signed, or linked to itself.
    fn unsupported(&self, is_directed: bool, error: &graph::GraphError) -> Problem {
        let (kind, steps, step) = match error {
            graph::GraphError::NotSymmetric { .. } if is_directed => (
                "is directed, but predictions are for undirected networks: weights above zero, the \
                 same in both directions, and no self-loops",
                "a step of preparation can make both directions equal by their mean, max or union",
                "symmetrise=mean",
            ),
            graph::GraphError::SelfLoop { .. } => {
                ("has self-loops", "a step of preparation takes them away", "drop_self_loops")
            }
            _ => (
                "is no undirected network of weights above zero",
                "a step of preparation can drop links whose weights are too small",
                "threshold=0",
            ),
        };
        self.of_network(&format!("{kind}: {error}")).hint(format!(
            "{steps}: `--prepare {step}` of `eigensync predict`, or `prepare` in an experiment file"
        ))
    }

    /// A problem with the network itself, which names the file that it was read from.
    pub(super) fn of_network(&self, message: &str) -> Problem {
        match &self.experiment.network {
            NetworkSpec::File(FileSpec { path, .. })
            | NetworkSpec::Hierarchical(HierarchicalSpec { path, .. }) => {
                let path = shown(self.beside(path));
                self.problem("network", format!("from {path} {message}"))
            }
            NetworkSpec::Communities(_) => self.problem("network", message),
        }
    }

    fn beside(&self, path: &Path) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(path)
    }

    fn file(&self, spec: &FileSpec) -> Result<RawNetwork> {
        let key = "network.file.path";
        if let Some(bytes) = &spec.given {
            self.readable(key, bytes.len() as u64)?;
            let source = std::io::Cursor::new(bytes);
            return self.stages.unmeasured("reading", || self.read(spec, &spec.path, source));
        }
        let (path, source) = self.open(key, &spec.path, spec.fetched_by.as_deref())?;
        let n_bytes = source.metadata().map_or(0, |metadata| metadata.len());
        if spec.format().lists_links {
            self.readable(key, n_bytes)?;
        }
        self.stages.measured("reading", n_bytes, |progress| {
            self.read(spec, &path, BufReader::new(Watched { source, progress }))
        })
    }

    fn read(
        &self,
        spec: &FileSpec,
        path: &Path,
        mut source: impl Read + Seek,
    ) -> Result<RawNetwork> {
        (spec.format().read)(&mut source, &self.options(spec)?).map_err(|error| {
            self.problem("network.file.path", format!("names {}: {error}", shown(path)))
        })
    }

    /// Opens a file that an experiment names. One that is fetched by a command and is not there leaves
    /// the experiment out.
    fn open(&self, key: &str, path: &Path, fetched_by: Option<&str>) -> Result<(PathBuf, File)> {
        let path = self.beside(path);
        let named = |message: String| self.problem(key, format!("names {}{message}", shown(&path)));
        let source = files::open(&path).map_err(|error| match (error.kind(), fetched_by) {
            (std::io::ErrorKind::NotFound, Some(command)) => named(", which is not here".into())
                .hint(format!("`{command}` brings it"))
                .left_out(),
            (std::io::ErrorKind::NotFound, None) => named(", which does not exist".into())
                .hint("paths are relative to the folder of the experiment file"),
            _ => match files::kind(&path) {
                Ok(kind) if kind != files::REGULAR => {
                    named(format!(", which is {kind}; expected {}", files::REGULAR))
                }
                _ => named(format!(", which cannot be opened: {error}")),
            },
        })?;
        Ok((path, source))
    }

    /// What the file says of how it is to be read.
    fn options(&self, spec: &FileSpec) -> Result<Options> {
        let block = match spec.block {
            None => None,
            Some(block) => {
                Some(range(block).map_err(|why| self.problem("network.file.block", why))?)
            }
        };
        let rows = match spec.rows {
            RowsSpec::Driven => Rows::Driven,
            RowsSpec::Driving => Rows::Driving,
        };
        let AttributesSpec { weight, label, group, position } = spec.attributes.clone();
        Ok(Options {
            variable: spec.variable.clone(),
            attributes: Attributes { weight, label, group, position },
            layout: Layout { rows, block },
        })
    }

    fn communities(&self, spec: &CommunitiesSpec) -> Result<Network> {
        let key = "network.communities";
        let probability = match (&spec.probability, spec.p_within, spec.p_between) {
            (Some(matrix), None, None) => LinkProbability::Matrix(matrix.clone()),
            (None, Some(within), Some(between)) => LinkProbability::Uniform { within, between },
            _ => {
                let message = "needs either `p_within` and `p_between`, or `probability`";
                return Err(self.problem(key, message));
            }
        };
        let n_nodes = spec.sizes.iter().map(|&size| size as f64).sum();
        self.generable(n_nodes, expected_links(&spec.sizes, &probability))?;
        communities(&spec.sizes, &probability, spec.seed.unwrap_or(self.experiment.seed))
            .map_err(|error| self.problem(key, format!("cannot be generated: {error}")))
    }

    fn hierarchical(&self, spec: &HierarchicalSpec) -> Result<Network> {
        let key = "network.hierarchical";
        let (path, source) = self.open(&format!("{key}.path"), &spec.path, None)?;
        let backbone = formats::edge_list::read(source).map_err(|error| {
            self.problem(&format!("{key}.path"), format!("names {}: {error}", shown(&path)))
        })?;
        let seed = spec.seed.unwrap_or(self.experiment.seed);
        let factor = spec.p_between_per_weight;
        let n_nodes = spec.size as f64 * backbone.n_nodes() as f64;
        let n_links = expected_hierarchical_links(&backbone, spec.size, spec.p_within, factor);
        self.generable(n_nodes, n_links)?;
        hierarchical(&backbone, spec.size, spec.p_within, factor, seed)
            .map_err(|error| self.problem(key, format!("cannot be generated: {error}")))
    }

    fn grouped(&self, network: Network) -> Result<Network> {
        let groups = match &self.experiment.groups {
            None => return Ok(network),
            Some(GroupsSpec::Ranges(ranges)) => {
                let group = |(name, bounds): (&String, &[usize; 2])| {
                    let key = format!("groups.ranges.{name}");
                    let nodes = range(*bounds).map_err(|why| self.problem(&key, why))?;
                    if nodes.end > network.n_nodes() {
                        let message = format!(
                            "names nodes {} to {}, but the network has {}",
                            bounds[0],
                            bounds[1],
                            network.n_nodes()
                        );
                        return Err(self.problem(&key, message));
                    }
                    Ok(Group { name: name.clone(), nodes: nodes.collect() })
                };
                ranges.iter().map(group).collect::<Result<_>>()?
            }
            Some(GroupsSpec::File { path }) => self.groups_of_file(path, network.n_nodes())?,
        };
        network
            .with_groups(groups)
            .map_err(|error| self.problem("groups", format!("do not fit the network: {error}")))
    }

    fn groups_of_file(&self, path: &Path, n_nodes: usize) -> Result<Vec<Group>> {
        let (path, source) = self.open("groups.file.path", path, None)?;
        let mut text = String::new();
        let read = source.take(MOST_GROUP_BYTES + 1).read_to_string(&mut text);
        let too_long = || std::io::Error::other(format!("more than {MOST_GROUP_BYTES} bytes"));
        let read =
            read.and_then(|n| if n as u64 > MOST_GROUP_BYTES { Err(too_long()) } else { Ok(n) });
        read.map_err(|error| {
            self.problem("groups.file.path", format!("names {}: {error}", shown(&path)))
        })?;
        let names: Vec<&str> = text.lines().map(str::trim).collect();
        if names.len() != n_nodes || names.contains(&"") {
            let message = format!(
                "names {}, which has {} lines with a name; expected one for each of the {n_nodes} \
                 nodes",
                shown(&path),
                names.iter().filter(|name| !name.is_empty()).count()
            );
            return Err(self.problem("groups.file.path", message));
        }
        let mut groups = indexmap::IndexMap::<&str, Vec<usize>>::new();
        for (node, name) in names.into_iter().enumerate() {
            groups.entry(name).or_default().push(node);
        }
        Ok(groups.into_iter().map(|(name, nodes)| Group { name: name.into(), nodes }).collect())
    }
}

/// Longest file of groups, in bytes: names of 100 characters for five million nodes.
const MOST_GROUP_BYTES: u64 = 512 << 20;

/// First and last, counted from 1, as a range counted from 0.
fn range([first, last]: [usize; 2]) -> std::result::Result<Range<usize>, String> {
    if first == 0 || last < first {
        return Err(format!("is [{first}, {last}]; expected first and last, counted from 1"));
    }
    Ok(first - 1..last)
}

fn step(spec: &StepSpec) -> std::result::Result<Step, String> {
    Ok(match spec {
        StepSpec::Nodes(ranges) => {
            let ranges: std::result::Result<_, String> = ranges.iter().map(|r| range(*r)).collect();
            Step::Select(Selection::Ranges(ranges?))
        }
        StepSpec::Labels(labels) => {
            Step::Select(Selection::Labels(labels.iter().map(|name| name.0.clone()).collect()))
        }
        StepSpec::DropSelfLoops => Step::DropSelfLoops,
        StepSpec::Symmetrise(rule) => Step::Symmetrise(match rule {
            SymmetriseSpec::Union => Symmetrise::Union,
            SymmetriseSpec::Mean => Symmetrise::Mean,
            SymmetriseSpec::Max => Symmetrise::Max,
        }),
        StepSpec::Threshold(threshold) => Step::Threshold(*threshold),
        StepSpec::Binarise => Step::Binarise,
        StepSpec::DropIsolated => Step::DropIsolated,
        StepSpec::LargestComponent => Step::LargestComponent,
    })
}
